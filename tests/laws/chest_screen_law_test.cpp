// The chest wall's patches and edge enhancement against closed forms.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "signal/chest_screen.h"
#include "signal/edge_enhancement.h"
#include "signal/sector_loss.h"
#include "support/plain_scene.h"

namespace echocine::chest_screen_law {
namespace {

using namespace support;

Probe sectorProbe() {
  Probe probe = plainScene({medium("tissue", 1060, 1540, 15, 0.1)}).probe;
  probe.lines = 64;
  probe.samples = 200;
  probe.first_angle_rad = -0.6;
  probe.last_angle_rad = 0.6;
  probe.min_depth_m = 0;
  probe.max_depth_m = 0.1;
  return probe;
}

ArtefactSettings patches(double deviation_db, double grain_m, int seed) {
  ArtefactSettings a;
  a.shading_db = deviation_db;
  a.shading_grain_m = grain_m;
  a.shading_depth_m = 0.02;
  a.shading_seed = seed;
  return a;
}

struct Moments {
  double mean = 0, deviation = 0;
};
Moments momentsOf(const std::vector<double>& values) {
  Moments m;
  for (const double v : values) m.mean += v / static_cast<double>(values.size());
  for (const double v : values)
    m.deviation += (v - m.mean) * (v - m.mean) / static_cast<double>(values.size());
  m.deviation = std::sqrt(m.deviation);
  return m;
}

// Two-way levels of 400 chest walls, in dB.
Moments levels(double aperture_m, double grain_m) {
  Probe probe = sectorProbe();
  probe.aperture_m = aperture_m;
  std::vector<double> values;
  for (int seed = 1; seed <= 400; ++seed)
    values.push_back(10 *
                     std::log10(ChestScreen(probe, patches(3, grain_m, seed)).factor(0, 0, 0.1)));
  return momentsOf(values);
}

// A log-normal factor of 3 dB one way: 6 dB both ways, about -40 log10 exp(s^2 / 2).
TEST(ChestScreenLaw, VariesByTwiceItsDeviationBehindASmallAperture) {
  const Moments m = levels(1e-4, 0.02);
  const double s = 3 * std::numbers::ln10 / 20;
  EXPECT_NEAR(m.deviation, 6, 0.6);
  EXPECT_NEAR(m.mean, -40 / std::numbers::ln10 * s * s / 2, 0.9);
}

// An aperture of N grains averages them: the deviation falls as the root of N.
TEST(ChestScreenLaw, EvensOutBehindAnApertureOfManyPatches) {
  const double wide = levels(0.08, 4e-4).deviation, less = levels(0.02, 4e-4).deviation;
  EXPECT_LT(wide, 0.6);
  EXPECT_NEAR(less / wide, 2, 0.3);
}

// A wall of even thickness: in dB, half of the loss at half the depth, and no step at its far side.
TEST(ChestScreenLaw, GrowsWithinTheWallWithoutAStep) {
  const ChestScreen screen(sectorProbe(), patches(4, 8e-3, 7));
  for (const double x_m : {-0.015, 0.0, 0.01}) {
    EXPECT_EQ(screen.factor(0, x_m, 0), 1);
    const double behind = screen.factor(0, x_m, 0.02 + 1e-9);
    EXPECT_NEAR(screen.factor(0, x_m, 0.01), std::sqrt(behind), 1e-3 * behind);
    EXPECT_NEAR(screen.factor(0, x_m, 0.005), std::pow(behind, 0.25), 1e-3 * behind);
    EXPECT_NEAR(screen.factor(0, x_m, 0.02 - 1e-9), behind, 1e-3 * behind);
  }
}

TEST(ChestScreenLaw, FollowsPathsBehind) {
  Probe probe = sectorProbe();
  probe.aperture_m = 0.02;
  const ChestScreen screen(probe, patches(4, 8e-3, 7));
  for (const auto& [x_m, z_m] : {std::pair(0.0, 0.05), {0.03, 0.06}, {-0.02, 0.12}}) {
    constexpr int kElements = 20000;  // second way: the mean over elements
    double sum = 0;
    for (int e = 0; e < kElements; ++e) {
      const double from_m = probe.aperture_m * ((e + 0.5) / kElements - 0.5);
      const double at_m = from_m + (x_m - from_m) * 0.02 / z_m;
      sum += screen.mean(at_m - 1e-6, at_m + 1e-6);
    }
    EXPECT_NEAR(screen.factor(0, x_m, z_m), std::pow(sum / kElements, 4), 1e-3);
  }
}

// Lines of a curved face start behind its middle. A small aperture sees each line through one place
// of the screen, so behind it a line's factor is constant.
TEST(ChestScreenLaw, IsConstantAlongALineOfACurvedFace) {
  Probe probe = sectorProbe();
  probe.kind = ProbeKind::curvilinear;
  probe.face_radius_m = 0.06;
  probe.aperture_m = 1e-6;
  const ArtefactSettings settings = patches(3, 8e-3, 5);
  EffectPlan plan;
  plan.shading = true;
  const std::vector<float> factors = sectorLosses(probe, settings, plan);
  const ChestScreen screen(probe, settings);
  for (const int line : {0, 20, 63}) {
    const double angle_rad = -0.6 + 1.2 * line / 63,
                 place_m = (probe.face_radius_m + settings.shading_depth_m) * std::tan(angle_rad);
    const double through = std::pow(screen.mean(place_m - 1e-5, place_m + 1e-5), 4);
    for (const int sample : {80, 120, 199})
      EXPECT_NEAR(static_cast<double>(factors[static_cast<std::size_t>(line * 200 + sample)]),
                  through, 2e-3 * through)
          << line << ' ' << sample;
  }
}

TEST(ChestScreenLaw, OfNoDeviationLosesNothingAndSeedsDiffer) {
  const Probe probe = sectorProbe();
  EXPECT_NEAR(ChestScreen(probe, patches(0, 8e-3, 1)).factor(0, 0.02, 0.1), 1, 1e-12);
  EXPECT_NE(ChestScreen(probe, patches(3, 8e-3, 1)).factor(0, 0.02, 0.1),
            ChestScreen(probe, patches(3, 8e-3, 2)).factor(0, 0.02, 0.1));
}

TEST(ChestScreenLaw, IsOneOfTheLossesOfTheSector) {
  const Probe probe = sectorProbe();
  ArtefactSettings settings = patches(3, 8e-3, 5);
  EffectPlan plan;
  EXPECT_TRUE(sectorLosses(probe, settings, plan).empty());
  plan.shading = true;
  const std::vector<float> factors = sectorLosses(probe, settings, plan);
  const ChestScreen screen(probe, settings);
  const double angle_rad = -0.6 + 1.2 * 40 / 63, path_m = 150.5 * 0.1 / 200;
  EXPECT_NEAR(static_cast<double>(factors[40 * 200 + 150]),
              screen.factor(0, path_m * std::sin(angle_rad), path_m * std::cos(angle_rad)), 1e-5);
}

// A step of height s between samples.
TEST(EdgeEnhancementLaw, KeepsConstantsAndRaisesAStepByHalfItsAmount) {
  const Probe probe = sectorProbe();
  SignalSettings settings;
  settings.edge_enhancement = 0.8;
  settings.edge_size_m = 20 * 0.1 / 200;  // 21 samples: 10 on either side
  const EdgeEnhancement edges(probe, settings);
  std::vector<float> plane(std::size_t{64} * 200, 0.4f);
  edges.apply(plane);
  for (const float g : plane) EXPECT_NEAR(g, 0.4f, 1e-6f);
  for (std::size_t i = 0; i < plane.size(); ++i) plane[i] = i % 200 < 100 ? 0.3f : 0.6f;
  edges.apply(plane);
  // Of the box about sample 100, as many samples lie above the step as below it, but its own.
  const auto size = [&](std::size_t k) { return plane[std::size_t{30} * 200 + k]; };
  EXPECT_NEAR(size(50), 0.3f, 1e-6f);
  EXPECT_NEAR(size(150), 0.6f, 1e-6f);
  const float above = size(100) - 0.6f, below = 0.3f - size(99);
  EXPECT_NEAR(above, below, 1e-6f);
  EXPECT_GT(above, 0.8f * 0.3f * 0.43f);
  EXPECT_LE(above, 0.8f * 0.3f * 0.5f);
}

// Second way: the mean over the box at one place.
TEST(EdgeEnhancementLaw, SubtractsTheMeanOverItsBox) {
  const Probe probe = sectorProbe();
  SignalSettings settings;
  settings.edge_enhancement = 0.5;
  settings.edge_size_m = 5e-3;
  std::vector<float> plane(std::size_t{64} * 200);
  for (std::size_t i = 0; i < plane.size(); ++i)
    plane[i] = 0.5f + 0.2f * std::sin(0.37f * static_cast<float>(i % 1237));
  const std::vector<float> before = plane;
  EdgeEnhancement(probe, settings).apply(plane);
  const double spacing_m = 0.05 * 1.2 / 63;
  const int half_lines = static_cast<int>(std::round((5e-3 / spacing_m - 1) / 2)), half = 5;
  const auto at = [&](int line, int k) {
    return static_cast<double>(before[static_cast<std::size_t>(line * 200 + k)]);
  };
  double lowest = 1e9;
  for (int samples_half : {half - 1, half}) {  // 10 samples round to either
    double sum = 0;
    int count = 0;
    for (int i = 30 - half_lines; i <= 30 + half_lines; ++i)
      for (int k = 90 - samples_half; k <= 90 + samples_half; ++k) sum += at(i, k), ++count;
    const double expected = std::clamp(at(30, 90) + 0.5 * (at(30, 90) - sum / count), 0.0, 1.0);
    lowest = std::min(lowest, std::abs(static_cast<double>(plane[30 * 200 + 90]) - expected));
  }
  EXPECT_LT(lowest, 1e-6);
}

}  // namespace
}  // namespace echocine::chest_screen_law
