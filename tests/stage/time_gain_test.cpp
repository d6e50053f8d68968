// Time gain by a table.

#include "signal/time_gain.h"

#include <gtest/gtest.h>

#include "support/plain_scene.h"

namespace echocine {
namespace {

// Samples centred at 1, 2, ... 100 mm.
Probe gainProbe() {
  Probe p = support::plainScene({support::medium("m", 1000, 1500)}).probe;
  p.min_depth_m = 0.0005;
  p.max_depth_m = 0.1005;
  p.samples = 100;
  return p;
}

double decibelsAt(const std::vector<float>& gains, int mm) {
  return 10 * std::log10(gains[static_cast<std::size_t>(mm - 1)]);
}

// As sliders do: straight in dB between them, held beyond the ends.
TEST(TimeGain, IsLinearInDecibelsBetweenThePointsAndConstantBeyond) {
  const std::vector<float> gains =
      timeGains({{0.01, 0}, {0.02, 20}, {0.06, 28}, {0.09, -4}}, gainProbe());
  for (const auto& [mm, db] : {std::pair(1, 0.0),
                               {10, 0.0},
                               {15, 10.0},
                               {20, 20.0},
                               {40, 24.0},
                               {60, 28.0},
                               {75, 12.0},
                               {90, -4.0},
                               {100, -4.0}})
    EXPECT_NEAR(decibelsAt(gains, mm), db, 1e-5) << mm;
}

TEST(TimeGain, OnePointIsTheSameGainEverywhere) {
  for (const float gain : timeGains({{0.05, 3}}, gainProbe()))
    EXPECT_FLOAT_EQ(gain, std::pow(10.0f, 0.3f));
}

TEST(TimeGain, MultipliesEveryLine) {
  const std::vector<float> gains{1, 2, 4};
  std::vector<float> plane{1, 1, 1, 3, 0, 5};
  applyTimeGains(gains, plane);
  EXPECT_EQ(plane, (std::vector<float>{1, 2, 4, 3, 0, 20}));
}

}  // namespace
}  // namespace echocine
