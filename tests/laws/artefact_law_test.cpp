// Artefacts against closed forms and direct sums.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/units.h"
#include "frame/persistence.h"
#include "signal/haze.h"
#include "signal/noise.h"
#include "signal/sector_loss.h"
#include "signal/signal_chain.h"
#include "signal/time_gain.h"
#include "support/plain_scene.h"

namespace echocine {
namespace {

using namespace support;

constexpr int kLines = 64, kSamples = 200;
constexpr std::size_t kSize = kLines * kSamples;

Scene sector() {
  Scene scene = plainScene({medium("tissue", 1060, 1540, 15, 0.1)});
  scene.probe.lines = kLines;
  scene.probe.samples = kSamples;
  scene.probe.max_depth_m = 0.1;
  return scene;
}

double pitch(const Probe& probe) {
  return (probe.last_angle_rad - probe.first_angle_rad) / (probe.lines - 1);
}

std::vector<float> impulse(int line, int sample) {
  std::vector<float> plane(kSize);
  plane[static_cast<std::size_t>(line * kSamples + sample)] = 1;
  return plane;
}

TEST(Dropout, FallsByTheFourthPowerToItsLossAtTheEdges) {
  EXPECT_DOUBLE_EQ(dropoutFactor(0, 12), 1);
  EXPECT_DOUBLE_EQ(dropoutFactor(1, 12), std::pow(10, -1.2));
  EXPECT_DOUBLE_EQ(dropoutFactor(-0.5, 16), std::pow(10, -0.1));
}

// Second way: a hundred thousand elements, each with its straight path.
TEST(RibGap, OpensThePartOfTheApertureWhosePathsPass) {
  const RibGap gap{
      .aperture_m = 0.02, .width_m = 0.015, .offset_m = 0.003, .depth_m = 0.012, .shadow_db = 24};
  for (const auto& [start_m, start_z_m] : {std::pair(0.0, 0.0), {-0.01, 0.0}, {0.02, -0.006}})
    for (const auto& [x_m, z_m] : {std::pair(0.0, 0.05),
                                   {0.03, 0.05},
                                   {-0.02, 0.03},
                                   {0.1, 0.1},
                                   {0.01, 0.0121},
                                   {-0.005, 0.15}}) {
      constexpr int kElements = 100000;
      int open = 0;
      for (int e = 0; e < kElements; ++e) {
        const double from_m = start_m + gap.aperture_m * ((e + 0.5) / kElements - 0.5);
        const double at_m = from_m + (x_m - from_m) * (gap.depth_m - start_z_m) / (z_m - start_z_m);
        if (std::abs(at_m - gap.offset_m) < gap.width_m / 2) ++open;
      }
      const double part = static_cast<double>(open) / kElements;
      EXPECT_NEAR(gap.openPart(start_m, x_m, z_m, start_z_m), part, 2e-5) << x_m << " " << z_m;
      const double tau = std::pow(10, -24.0 / 40);
      EXPECT_NEAR(gap.factor(start_m, x_m, z_m, start_z_m), std::pow(part + (1 - part) * tau, 4),
                  2e-4);
    }
}

TEST(RibGap, TakesNothingInFrontOfTheRibsAndItsWholeShadowBehindThem) {
  const RibGap gap{
      .aperture_m = 0.02, .width_m = 0.01, .offset_m = 0, .depth_m = 0.012, .shadow_db = 30};
  EXPECT_EQ(gap.factor(0, 0.1, 0.011), 1);
  EXPECT_NEAR(gap.factor(0, 0.2, 0.02), 1e-3, 1e-12);
  const RibGap wide{
      .aperture_m = 0.02, .width_m = 1, .offset_m = 0, .depth_m = 0.012, .shadow_db = 30};
  EXPECT_EQ(wide.factor(0, 0.02, 0.05), 1);
}

TEST(Haze, IsATwoSidedExponentialAcrossTheLines) {
  const Probe probe = sector().probe;
  const LateralHaze haze(probe, -20, 0.12);
  std::vector<float> plane = impulse(30, 77);
  haze.add(plane);
  const double a = std::exp(-pitch(probe) / 0.12);
  for (int i = 0; i < kLines; ++i)
    for (int k = 0; k < kSamples; ++k) {
      const double expected =
          k == 77 ? (i == 30) + 0.01 * (1 - a) / (1 + a) * std::pow(a, std::abs(i - 30)) : 0;
      EXPECT_NEAR(plane[static_cast<std::size_t>(i * kSamples + k)], expected, 1e-7);
    }
}

TEST(Haze, OfAnEvenFieldIsItsLevelBesidesTheEdges) {
  Scene scene = sector();
  std::vector<float> plane(kSize, 2.0f);
  LateralHaze(scene.probe, -13, 0.02).add(plane);
  const double a = std::exp(-pitch(scene.probe) / 0.02);
  const double beyond = std::pow(a, 32) * 2 / (1 + a);  // what both edges cut off, about
  EXPECT_NEAR(plane[32 * kSamples + 5], 2 + 2 * std::pow(10, -1.3), 0.2 * beyond + 1e-5);
}

TEST(Reverberation, IsAnExponentialTailThatSumsToItsLevel) {
  const Probe probe = sector().probe;
  const ReverberationTail tail(probe, -20, 6e-3);
  std::vector<float> plane = impulse(9, 20);
  tail.add(plane);
  const double a = std::exp(-probe.sampleSpacing() / 6e-3);
  double sum = 0;
  for (int k = 0; k < kSamples; ++k) {
    const double value = plane[static_cast<std::size_t>(9 * kSamples + k)];
    const double expected = k < 20 ? 0 : k == 20 ? 1 : 0.01 * (1 - a) / a * std::pow(a, k - 20);
    EXPECT_NEAR(value, expected, 1e-8) << k;
    if (k > 20) sum += value;
  }
  EXPECT_NEAR(sum, 0.01 * (1 - std::pow(a, kSamples - 21)), 1e-6);
  EXPECT_EQ(plane[10 * kSamples + 30], 0.0f);
}

double correlation(const std::vector<float>& a, const std::vector<float>& b, std::size_t lag) {
  double n = 0, x = 0, y = 0, xx = 0, yy = 0, xy = 0;
  for (std::size_t i = 0; i + lag < a.size(); ++i) {
    const double p = a[i], q = b[i + lag];
    n += 1, x += p, y += q, xx += p * p, yy += q * q, xy += p * q;
  }
  return (xy - x * y / n) / std::sqrt((xx - x * x / n) * (yy - y * y / n));
}

std::vector<float> powersOf(const RandomPlane& plane) {
  std::vector<float> out;
  for (int i = 0; i < plane.lines() * plane.samples(); ++i)
    out.push_back(plane.real(0)[i] * plane.real(0)[i] +
                  plane.imaginary(0)[i] * plane.imaginary(0)[i]);
  return out;
}

// Squared magnitude of a source's field, line by line.
template <typename Add>
std::vector<float> powersOf(const Add& add) {
  std::vector<float> out;
  for (int i = 0; i < kLines; ++i) {
    std::vector<float> real(kSamples), imaginary(kSamples);
    add(i, real.data(), imaginary.data());
    for (std::size_t k = 0; k < kSamples; ++k)
      out.push_back(real[k] * real[k] + imaginary[k] * imaginary[k]);
  }
  return out;
}

// Law of complex Gaussian noise through a bell of deviation s: intensities have their mean as
// deviation, and correlate by exp(-d^2 / 2 s^2).
TEST(RandomPlane, IsSpeckleOfItsGrain) {
  const RandomPlane plane(256, 1024, {.lateral_lines = 2, .axial_samples = 3}, 7);
  const std::vector<float> values = powersOf(plane);
  double sum = 0, squares = 0;
  for (const float v : values) sum += v, squares += static_cast<double>(v) * v;
  const double n = static_cast<double>(values.size());
  EXPECT_NEAR(sum / n, 1, 1e-5);
  EXPECT_NEAR(squares / n - 1, 1, 0.05);
  for (const std::size_t d : {1u, 3u, 6u}) {
    const auto lag2 = static_cast<double>(d * d);
    EXPECT_NEAR(correlation(values, values, d), std::exp(-lag2 / 18), 0.03) << d;
    EXPECT_NEAR(correlation(values, values, d * 1024), std::exp(-lag2 / 8), 0.03) << d;
  }
}

TEST(Noise, HasItsLevelUnderTheGainAndBoils) {
  Scene scene = sector();
  scene.artefacts.noise_db = -30;
  const std::vector<float> gains = nominalGains(15, scene.probe);
  const ReceiverNoise noise(scene, gains);
  const auto at = [&](double time_s) {
    return powersOf(
        [&](int i, float* real, float* imaginary) { noise.add(5e-4, time_s, i, real, imaginary); });
  };
  const auto even = [&](std::vector<float> plane) {  // the gain undone
    for (std::size_t i = 0; i < kSize; ++i) plane[i] /= gains[i % kSamples];
    return plane;
  };
  std::vector<double> mean(kSamples);
  constexpr int kInstants = 200;
  const std::vector<float> first = at(0);
  for (int t = 0; t < kInstants; ++t) {
    const std::vector<float> plane = at(0.02 * t);
    if (t > 0 && t < 6) {
      EXPECT_NEAR(correlation(even(first), even(plane), 0), 0, 0.05) << t;
    }
    for (std::size_t i = 0; i < kSize; ++i) mean[i % kSamples] += plane[i];
  }
  for (std::size_t k = 5; k < kSamples; k += 39)
    EXPECT_NEAR(mean[k] / (kInstants * kLines) / (5e-7 * gains[k] / gains.back()), 1, 0.05) << k;
  EXPECT_EQ(at(0), first);
}

TEST(Clutter, FallsExponentiallyAndDependsOnItsSeedAlone) {
  Scene scene = sector();
  scene.artefacts.clutter_db = -10;
  std::vector<double> mean(kSamples);
  constexpr int kSeeds = 60;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    scene.artefacts.clutter_seed = seed;
    const NearFieldClutter clutter(scene), same(scene);
    const auto of = [](const NearFieldClutter& c) {
      return powersOf(
          [&](int i, float* real, float* imaginary) { c.add(1, 0, i, real, imaginary); });
    };
    const std::vector<float> plane = of(clutter);
    EXPECT_EQ(plane, of(same));
    for (std::size_t i = 0; i < kSize; ++i) mean[i % kSamples] += plane[i] / (kSeeds * kLines);
  }
  for (const int k : {0, 20, 60}) {
    const double r_m = scene.probe.min_depth_m + (k + 0.5) * scene.probe.sampleSpacing();
    EXPECT_NEAR(mean[static_cast<std::size_t>(k)] / (0.1 * std::exp(-r_m / 6e-3)), 1, 0.15) << k;
  }
  EXPECT_EQ(mean[kSamples - 1], 0);
}

TEST(NominalGain, UndoesItsAttenuationBothWays) {
  const Probe probe = sector().probe;
  const std::vector<float> gains = nominalGains(8, probe);
  for (std::size_t k = 0; k < gains.size(); k += 50)
    EXPECT_NEAR(
        gains[k] * std::exp(-4 * 8 * (k + 0.5) * probe.sampleSpacing() - 4 * 8 * probe.min_depth_m),
        1, 1e-5);
}

TEST(PictureGain, IsAReferenceThatIsLowerBySoMuch) {
  Scene scene = sector();
  const EffectPlan plan = planEffects(scene);
  Intensities one(std::vector<float>(kSize, 3e-5f)), two = one;
  const Greys plain = SignalChain(scene, plan).compress(std::move(one), 1e-4);
  scene.signal.gain_db = 10;
  EXPECT_EQ(SignalChain(scene, plan).compress(std::move(two), 1e-3), plain);
}

class PersistenceOfGreys : public testing::Test {
 protected:
  static Acquisition tenFrames() {
    Acquisition a;
    a.heart_rate_hz = 1;
    a.frame_rate_hz = 10;
    return a;
  }
  static Greys alone(const FrameTime& time) {
    return Greys(std::vector<float>{static_cast<float>(time.time_s), 0.5f});
  }
  float shown(const Persistence& persistence, const FrameTime& time) const {
    Greys greys = alone(time);
    persistence.apply(1, time, greys, alone);
    EXPECT_NEAR(greys[1], 0.5f, 1e-7);
    return greys[0];
  }
  CardiacClock clock_{tenFrames()};
};

TEST_F(PersistenceOfGreys, IsAWeightedMeanOfTheFramesBefore) {
  const Persistence persistence(0.5, clock_, 10);
  ASSERT_EQ(persistence.depth(), 6);
  for (const int frame : {9, 3, 0, 7}) {
    double sum = 0, weights = 0;
    for (int j = 0; j <= std::min(frame, 6); ++j) {
      sum += std::pow(0.5, j) * (frame - j) / 10;
      weights += std::pow(0.5, j);
    }
    EXPECT_NEAR(shown(persistence, clock_.at(frame)), sum / weights, 1e-6) << frame;
  }
  EXPECT_NEAR(shown(persistence, clock_.atTime(0.12)), (0.12 + 0.5 * 0.02) / 1.5, 1e-6);
}

TEST_F(PersistenceOfGreys, AnyFrameAloneIsAsInTheLoop) {
  const Persistence loop(0.4, clock_, 10);
  for (int i = 0; i < 10; ++i) {
    const Persistence fresh(0.4, clock_, 10);
    EXPECT_EQ(shown(loop, clock_.at(i)), shown(fresh, clock_.at(i))) << i;
  }
}

}  // namespace
}  // namespace echocine
