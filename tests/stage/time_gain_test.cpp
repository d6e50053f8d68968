// Time gain by a table.

#include "signal/time_gain.h"

#include <gtest/gtest.h>

#include "plan/effect_plan.h"
#include "signal/signal_chain.h"
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

// In dB straight from the face to the depth where it ends, and nothing deeper; also on top of a
// table.
TEST(TimeGain, TheNearFieldsGainEndsAtItsDepth) {
  for (const bool with_table : {false, true}) {
    Scene scene = support::plainScene({support::medium("m", 1000, 1500)});
    scene.probe = gainProbe();
    scene.probe.lines = 2;
    scene.signal.beam_width = BeamWidth::none;
    scene.signal.tgc = with_table ? Tgc::table : Tgc::none;
    if (with_table) scene.signal.tgc_table = {{0, 3}};
    scene.signal.near_gain_db = -16;
    scene.signal.near_gain_depth_m = 0.04;
    EffectPlan plan = planEffects(scene);
    plan.beam_width = false;
    Intensities plane(std::vector<float>(200, 1.0f));
    SignalChain(scene, plan).process(plane, {0, 2}, {});
    for (int line = 0; line < 2; ++line)
      for (const int mm : {1, 10, 20, 39, 40, 41, 100}) {
        const double db = mm < 40 ? -16 * (1 - mm / 40.0) : 0;
        const float intensity = plane.values[static_cast<std::size_t>(100 * line + mm - 1)];
        EXPECT_NEAR(10 * std::log10(intensity), db + (with_table ? 3 : 0), 1e-4) << mm;
      }
  }
}

}  // namespace
}  // namespace echocine
