// Truth of the parametric heart is what was dialled.

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "core/parallel.h"
#include "motion/cycle/cardiac_timing.h"
#include "motion/heart/heart.h"
#include "motion/heart/heart_scene.h"
#include "motion/surfaces/interior_motion.h"
#include "scene/scene_reader.h"
#include "support/measured.h"
#include "support/paths.h"
#include "truth/frame_truth.h"

namespace echocine {
namespace {

constexpr std::size_t kInfarct = 6;  // mid anterior, from 0

TEST(HeartFunctionLaw, AnInfarctStrainsLessThanTheRest) {
  heart::Parameters parameters;
  parameters.segments[kInfarct].amplitude = 0;
  Scene scene;
  withThreads(1, [&] { scene = heart::heartScene(parameters, heart::View::a4c, 6, Look::paper); });
  scene.truth.function = true;
  const MeshMotion motion(scene);
  const MotionField field = interiorMotion(scene, motion);
  const HeartFunction function(scene, motion, field, 0);
  SurfaceFrame surfaces;
  FieldFrame frame;
  const double end_systole = scene.motion.end_systole_phase.value();
  motion.frameAt(end_systole, surfaces);
  field.at(end_systole, frame);
  const FunctionFrame f = function.at(surfaces, frame);
  const SegmentStrain& ill = f.segments[kInfarct];
  for (std::size_t s = 0; s < kAhaSegments; ++s) {
    if (s == kInfarct) continue;
    EXPECT_LT(f.segments[s].circumferential, ill.circumferential) << kAhaNames[s];
  }
  EXPECT_LT(f.global_longitudinal_strain, -0.1);
}

// Of the heart that is shipped: its dials and its timing, as data/beating_heart has them.
TEST(HeartFunctionLaw, TheShippedHeartHasWhatWasDialled) {
  Scene scene =
      readScene(std::filesystem::path(support::kSourceDir) / "examples/beating_heart/scene.toml");
  scene.truth.function = true;
  const MeshMotion motion(scene);
  const TruthMaker maker(scene, motion, {}, 0);
  const heart::Parameters dials;
  const CycleEvents events = heart::Cycle(dials).events();
  const FunctionFrame f = *maker.at({events.aortic_closes, 0, 0, 1}).function;
  EXPECT_NEAR(f.base_descent_mm, dials.mapse_mm, 0.5);
  EXPECT_NEAR(f.twist_deg, dials.twist_deg, 1);
  EXPECT_NEAR(f.biplane_ml / f.volume_ml, 1, 0.15);
  ASSERT_TRUE(f.mitral && f.mitral->hinges_m && f.tricuspid);
  EXPECT_LT(f.mitral->hinges_m->first.x, f.mitral->hinges_m->second.x);
  EXPECT_GE(f.tricuspid_descent_mm, 17);
  ASSERT_TRUE(maker.view() && maker.valves());
  EXPECT_STREQ(maker.view()->label, "a4c");
  EXPECT_LT(std::abs(*maker.view()->foreshortening_mm), 1);
  const double near = 10e-3 * dials.heart_rate_bpm / 60;  // 10 ms
  EXPECT_LT(std::abs(std::remainder(maker.valves()->mitral_closes, 1.0)), near);
  support::Largest("aortic opening off by", "ms")(
      1e3 * 60 / dials.heart_rate_bpm * (maker.valves()->aortic_opens - events.aortic_opens));
  EXPECT_NEAR(maker.valves()->aortic_opens, events.aortic_opens, near / 5);
  EXPECT_NEAR(maker.valves()->aortic_closes, events.aortic_closes, near);
  EXPECT_NEAR(maker.valves()->mitral_opens, events.mitral_opens, near);
}

// The volume's shape is told by hand: full until 0.1, empty from 0.4 to 0.5, full again at 0.9.
TEST(HeartFunctionLaw, ValvesFollowTheVolume) {
  std::vector<double> volume_ml;
  for (int i = 0; i < 1000; ++i) {
    const double phase = i / 1000.0;
    volume_ml.push_back(phase < 0.1   ? 100
                        : phase < 0.4 ? 100 - 50 * (phase - 0.1) / 0.3
                        : phase < 0.5 ? 50
                        : phase < 0.9 ? 50 + 50 * (phase - 0.5) / 0.4
                                      : 100);
  }
  const std::optional<ValveTimes> valves = valveTimes(volume_ml);
  ASSERT_TRUE(valves);
  // This flow begins at once instead of linearly: the extrapolation is early by 0.0057 at most.
  EXPECT_NEAR(valves->aortic_opens, 0.1, 0.006);
  EXPECT_NEAR(valves->aortic_closes, 0.4, 0.005);
  EXPECT_NEAR(valves->mitral_opens, 0.5, 0.006);
  EXPECT_NEAR(valves->mitral_closes, 0.9, 0.006);
  EXPECT_FALSE(valveTimes(std::vector<double>(100, 80.0)));
}

}  // namespace
}  // namespace echocine
