// Noise and clutter as fields: statistics of their sum with speckle, independence, repeatability.

#include <gtest/gtest.h>

#include <cmath>

#include "core/normal_lanes.h"
#include "core/parallel.h"
#include "signal/field_sum.h"
#include "support/measured.h"
#include "support/speckle_bed.h"

namespace echocine {
namespace {

using namespace support;

constexpr int kLines = 240, kSamples = 900;

struct NoisyBed {
  SpeckleBed bed{ProbeKind::phased, kLines, kSamples, 0.03, 0.165};
  Scene scene = plainScene({medium("tissue", 1050, 1540)});
  EffectPlan plan;

  explicit NoisyBed(double smoothing_m = 0) {
    scene.probe = bed.probe;
    scene.artefacts.noise_db = 0;
    scene.artefacts.clutter_db = 0;
    scene.artefacts.clutter_length_m = 10;  // even over the picture
    scene.speckle.smoothing_m = bed.settings.smoothing_m = smoothing_m;
    plan.noise = true;
    plan.clutter = false;
  }
  // Tissue of an intensity under noise of intensity 1.
  std::vector<float> sum(const Speckle& speckle, float tissue, double time_s = 0) const {
    std::vector<float> intensities = bed.even(tissue);
    EchoField field;
    field.resize(intensities.size());
    speckle.apply(Affine{}, 0, intensities, {}, {0, kLines}, &field);
    FieldSum(scene, plan, {}).add(1, time_s, field, intensities);
    return intensities;
  }
  std::vector<float> noise(double time_s) const {
    std::vector<float> intensities = bed.even(0);
    FieldSum(scene, plan, {}).add(1, time_s, {}, intensities);
    return intensities;
  }
};

struct FieldMoments {
  double mean = 0, envelope_snr = 0;
  explicit FieldMoments(const std::vector<float>& plane) {
    double a = 0;
    for (const float v : plane) mean += v, a += std::sqrt(static_cast<double>(v));
    const double n = static_cast<double>(plane.size());
    mean /= n, a /= n;
    envelope_snr = a / std::sqrt(mean - a * a);
  }
};

TEST(NoiseLaw, NormalNumbersAreComplexGaussianAndIndependent) {
  double n = 0, re = 0, im = 0, rr = 0, ii = 0, ri = 0, fourth = 0, next = 0, before = 0;
  for (std::uint64_t key = 1; key <= 64; ++key)
    for (std::uint32_t first = 0; first < 4096; first += 8) {
      const ComplexLanes z = complexNormals(key * 0x9e3779b97f4a7c15, first);
      for (std::size_t i = 0; i < kFloatLanes; ++i) {
        const double x = z.real[i], y = z.imaginary[i];
        n += 1, re += x, im += y, rr += x * x, ii += y * y, ri += x * y;
        fourth += std::pow(x * x + y * y, 2);
        next += x * before;
        before = x;
      }
    }
  const double error = 4 / std::sqrt(n);  // of means, four deviations
  EXPECT_NEAR(re / n, 0, error);
  EXPECT_NEAR(im / n, 0, error);
  EXPECT_NEAR(rr / n, 0.5, error);
  EXPECT_NEAR(ii / n, 0.5, error);
  EXPECT_NEAR(ri / n, 0, error);
  EXPECT_NEAR(next / n, 0, error);
  EXPECT_NEAR(fourth / n, 2, 5 * error);
}

// A sum of complex Gaussian fields is one: the envelope of speckle and noise is Rayleigh's,
// whatever their ratio. A sum of intensities would have 2.7 at equal power.
TEST(NoiseLaw, SpeckleAndNoiseTogetherAreRayleigh) {
  support::Largest off("SNR over 1.913, less 1,", "");
  NoisyBed noisy;
  for (const float tissue : {0.0f, 0.3f, 1.0f, 3.0f}) {
    std::vector<float> all;
    for (noisy.bed.settings.seed = 1; noisy.bed.settings.seed <= 4; ++noisy.bed.settings.seed) {
      const std::vector<float> one =
          noisy.sum(noisy.bed.speckle(), tissue, 0.02 * noisy.bed.settings.seed);
      all.insert(all.end(), one.begin(), one.end());
    }
    const FieldMoments m(all);
    EXPECT_NEAR(off(m.envelope_snr / 1.913 - 1), 0, 0.01) << tissue;
    EXPECT_NEAR(10 * std::log10(m.mean / (1 + static_cast<double>(tissue))), 0, 0.05) << tissue;
  }
}

TEST(NoiseLaw, ClutterIsAFieldTooAndStandsStill) {
  NoisyBed noisy;
  noisy.plan.noise = false;
  noisy.plan.clutter = true;
  EXPECT_EQ(noisy.noise(0), noisy.noise(0.3));
  const Speckle speckle = noisy.bed.speckle();
  EXPECT_EQ(noisy.sum(speckle, 1, 0), noisy.sum(speckle, 1, 0.3));
  std::vector<float> all;
  for (noisy.bed.settings.seed = 1; noisy.bed.settings.seed <= 8; ++noisy.bed.settings.seed) {
    noisy.scene.artefacts.clutter_seed = noisy.bed.settings.seed;
    const std::vector<float> one = noisy.sum(noisy.bed.speckle(), 1);
    all.insert(all.end(), one.begin(), one.end());
  }
  EXPECT_NEAR(FieldMoments(all).envelope_snr / 1.913, 1, 0.02);
}

// Averaged, the sum is what draws tend to: with the mean power of both, and of no seed or instant.
TEST(NoiseLaw, AveragedIsTheMeanOfTheDraws) {
  NoisyBed noisy;
  noisy.plan.clutter = true;
  noisy.scene.artefacts.noise_db = -3;
  noisy.scene.artefacts.clutter_length_m = 0.05;
  constexpr int kDraws = 24;
  constexpr float kEven = 0.2f;
  std::vector<double> drawn(kSamples);
  for (int seed = 1; seed <= kDraws; ++seed) {
    noisy.scene.artefacts.clutter_seed = noisy.scene.artefacts.noise_seed = seed;
    std::vector<float> plane = noisy.bed.even(kEven);
    FieldSum(noisy.scene, noisy.plan, {}).add(0.5, 0, {}, plane);
    for (std::size_t i = 0; i < plane.size(); ++i) drawn[i % kSamples] += plane[i];
  }
  noisy.plan.averaged = true;
  const FieldSum sum(noisy.scene, noisy.plan, {});
  EXPECT_TRUE(sum.adds());
  std::vector<float> mean = noisy.bed.even(kEven), other = mean;
  sum.add(0.5, 0, {}, mean);
  noisy.scene.artefacts.clutter_seed = noisy.scene.artefacts.noise_seed = 7;
  FieldSum(noisy.scene, noisy.plan, {}).add(0.5, 0.3, {}, other);
  EXPECT_EQ(mean, other);
  for (std::size_t k = 10; k < kSamples; k += 97) {
    const double added = static_cast<double>(mean[k]) - static_cast<double>(kEven);
    EXPECT_GT(added, 0.2) << k;
    EXPECT_NEAR((drawn[k] / (kDraws * kLines) - static_cast<double>(kEven)) / added, 1, 0.1) << k;
  }
}

TEST(NoiseLaw, AnyNumberOfThreadsGivesTheSameBytes) {
  NoisyBed noisy(0.6e-3);
  noisy.plan.clutter = true;
  const Speckle speckle = noisy.bed.speckle();
  std::vector<float> one;
  withThreads(1, [&] { one = noisy.sum(speckle, 1, 0.1); });
  for (const int threads : {2, 4})
    withThreads(threads, [&] { EXPECT_EQ(noisy.sum(speckle, 1, 0.1), one) << threads; });
}

// Over shifts of up to 24 lines and 48 samples either way, lines that wrap round included.
double bestShift(const std::vector<float>& a, const std::vector<float>& b) {
  double best = -1;
  for (int i = -24; i <= 24; i += 2)
    for (int k = -48; k <= 48; k += 4) {
      const Window w{24, kLines - 24, 48, kSamples - 48};
      best = std::max(best, std::abs(correlation(a, b, kSamples, w, i, k)));
    }
  return best;
}

TEST(NoiseLaw, FramesAreIndependentAtAnyShift) {
  const NoisyBed noisy;
  const std::vector<float> one = noisy.noise(0), two = noisy.noise(0.02);
  EXPECT_NEAR(bestShift(one, one), 1, 1e-9);
  EXPECT_LT(support::Largest("correlation at the best shift", "")(bestShift(one, two)), 0.02);
}

TEST(NoiseLaw, LinesAreIndependentAndThePulseLimitsTheBand) {
  const NoisyBed noisy;
  const std::vector<float> plane = noisy.noise(0);
  const Window w{0, kLines - 3, 0, kSamples - 8};
  for (const int lines : {1, 2})
    EXPECT_NEAR(correlation(plane, plane, kSamples, w, lines), 0, 0.02);
  const double sigma = PointSpread(noisy.scene.probe, noisy.scene.signal.pulse_cycles).axial_m /
                       noisy.scene.probe.sampleSpacing();
  for (const int k : {1, 2, 4})
    EXPECT_NEAR(correlation(plane, plane, kSamples, w, 0, k),
                std::exp(-k * k / (2 * sigma * sigma)), 0.02)
        << k;
}

// The filter is that of the pulse at any number of samples.
TEST(NoiseLaw, GrainAndPowerDoNotDependOnTheSamples) {
  for (const int samples : {100, 600, 6000, 40000}) {
    NoisyBed noisy;
    noisy.scene.probe.samples = samples;
    noisy.scene.probe.lines = std::max(8, 60000 / samples);
    std::vector<float> plane(static_cast<std::size_t>(samples * noisy.scene.probe.lines));
    double mean = 0, both = 0, squares = 0, n = 0;
    const double sigma = PointSpread(noisy.scene.probe, noisy.scene.signal.pulse_cycles).axial_m /
                         noisy.scene.probe.sampleSpacing();
    const int lag = std::max(1, static_cast<int>(sigma));
    for (int t = 0; t < 12; ++t) {
      std::fill(plane.begin(), plane.end(), 0.0f);
      FieldSum(noisy.scene, noisy.plan, {}).add(1, 0.1 * t, {}, plane);
      for (int i = 0; i < noisy.scene.probe.lines; ++i)
        for (int k = 0; k + lag < samples; ++k) {
          const double a = plane[static_cast<std::size_t>(i * samples + k)],
                       b = plane[static_cast<std::size_t>(i * samples + k + lag)];
          n += 1, mean += a, squares += a * a, both += a * b;
        }
    }
    mean /= n;
    EXPECT_NEAR(mean, 1, 0.05) << samples;
    EXPECT_NEAR((both / n - mean * mean) / (squares / n - mean * mean),
                std::exp(-lag * lag / (2 * sigma * sigma)), 0.06)
        << samples;
  }
}

TEST(NoiseLaw, AnInstantHasItsNoiseInAnyOrderAndWithAnyThreads) {
  const NoisyBed noisy(0.7e-3);
  const Speckle speckle = noisy.bed.speckle();
  const std::vector<float> one = noisy.sum(speckle, 1, 0.1);
  (void)noisy.sum(speckle, 1, 0.3);
  for (const int threads : {1, 2})
    withThreads(threads, [&] { EXPECT_EQ(noisy.sum(speckle, 1, 0.1), one); });
  EXPECT_NE(noisy.sum(speckle, 1, 0.12), one);
}

// Without noise the field has the picture's own intensities.
TEST(NoiseLaw, TheFieldIsThatOfTheIntensities) {
  NoisyBed noisy;
  noisy.plan.noise = false;
  const std::vector<float> with = noisy.sum(noisy.bed.speckle(), 2);
  std::vector<float> without = noisy.bed.even(2);
  noisy.bed.speckle().apply(Affine{}, 0, without);
  for (std::size_t i = 0; i < with.size(); ++i)
    ASSERT_NEAR(with[i], without[i], 1e-5f + 1e-5f * without[i]);
}

}  // namespace
}  // namespace echocine
