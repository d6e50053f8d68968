// Few keyframes, blended as the published volume curve goes: what is known is kept, and nothing
// leaves the way between what is known.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "core/units.h"
#include "motion/cycle/cardiac_timing.h"
#include "motion/surfaces/motion_warnings.h"
#include "tests/stage/motion_fixtures.h"
#include "tests/support/paths.h"

namespace echocine::motion_test {
namespace {

const std::filesystem::path kReal = std::filesystem::path(support::kSharedDir) / "real";

double weightOfSecond(const KeyframeWeights& weights, double phase) {
  std::array<double, 2> w{};
  weights.at(phase, w);
  return w[1];
}

// Law: between end-diastole and end-systole the weight of end-systole is 1 - V but for the drift,
// V the filled share of VolumeCurve, at any heart rate.
TEST(CycleInterpolationLaw, TheWeightIsTheEjectedShareOfThePublishedCurve) {
  for (const double bpm : {45.0, 65.0, 100.0, 150.0}) {
    const RecordedBeat beat{bpm / 60, {}};
    const PhaseDurations durations = phaseDurations(beat.heart_rate_hz);
    const VolumeCurve curve(durations);
    const double end_systole = cycleEvents(durations).aortic_closes;
    const KeyframeWeights weights(std::vector{0.0, end_systole}, Interpolation::cycle, {},
                                  HeartPace(beat));
    for (int i = 0; i <= 500; ++i)
      ASSERT_NEAR(weightOfSecond(weights, i / 500.0), 1 - curve.at(i / 500.0), HeartPace::kDrift)
          << bpm << " bpm, phase " << i / 500.0;
  }
}

// Law: the way ascends strictly, each weight lies in [0, 1], whatever the number of keyframes.
TEST(CycleInterpolationLaw, NoWeightIsNegativeAndTheWayNeverGoesBack) {
  const HeartPace pace(RecordedBeat{1.2, 0.4});
  for (int i = 0; i < 2000; ++i)
    ASSERT_LT(pace.travelled(i / 1000.0), pace.travelled((i + 1) / 1000.0)) << i;
  EXPECT_DOUBLE_EQ(pace.travelled(1), 2 + HeartPace::kDrift);
  const std::vector<std::vector<double>> sets{{0.0, 0.36}, {0.1, 0.2, 0.9}, {0.0, 0.36, 0.5, 0.8}};
  for (const std::vector<double>& phases : sets) {
    const KeyframeWeights weights(phases, Interpolation::cycle, {}, pace);
    std::vector<double> w(phases.size());
    for (int i = 0; i < 1000; ++i) {
      weights.at(i / 1000.0, w);
      for (const double weight : w) ASSERT_TRUE(weight >= 0 && weight <= 1) << i;
    }
  }
}

// mL of the patient's left ventricle at frames 0..24, as published with the meshes.
constexpr std::array<double, 25> kPublished_ml{
    174.5, 169.4, 156.2, 140.2, 121.8, 107.0, 96.8,  82.0,  79.0,  72.0,  77.5,  80.3, 88.1,
    104.3, 119.2, 135.7, 144.8, 150.2, 150.1, 147.6, 146.1, 149.1, 154.6, 170.1, 179.0};

// The patient's frames 0 and 9 alone, which is what a segmentation of two phases gives.
Scene twoPhases(Interpolation kind) {
  Structure structure;
  structure.name = "lv";
  structure.place = {"scene.toml", 7, "structure.keyframes"};
  for (const int k : {0, 9})
    structure.keyframes.push_back(
        {{kReal / "meshes/bivme_patient1_25f" / fmt::format("lv_endo_closed_{:03}.obj", k)},
         k / 25.0});
  Scene scene = sceneOf(structure);
  scene.motion.mesh_unit_m = 1e-3;
  scene.motion.interpolation = kind;
  scene.acquisition = {.heart_rate_hz = 72.2 / 60, .frame_rate_hz = 50, .beats = 1};
  return scene;
}

double volumeAt_ml(const MeshMotion& motion, double phase) {
  SurfaceFrame frame;
  motion.frameAt(phase, frame);
  return millilitresFromCubicMetres(enclosedVolume(motion.surfaces()[0], frame.positions_m[0]));
}

// Bound: 12 % of the end-diastolic volume all through the beat, with two of its 25 frames known.
TEST(CycleInterpolationLaw, APatientsTwoPhasesFollowTheRealVolumeCurve) {
  if (!std::filesystem::exists(kReal)) GTEST_SKIP() << "no real data beside the project";
  const MeshMotion motion(twoPhases(Interpolation::cycle));
  double worst_ml = 0;
  for (std::size_t k = 0; k < kPublished_ml.size(); ++k)
    worst_ml = std::max(
        worst_ml, std::abs(volumeAt_ml(motion, static_cast<double>(k) / 25) - kPublished_ml[k]));
  RecordProperty("worst_ml", fmt::format("{:.1f}", worst_ml));
  EXPECT_LT(worst_ml, 0.12 * kPublished_ml[0]);
  EXPECT_NEAR(volumeAt_ml(motion, 0), kPublished_ml[0], 0.1);
  EXPECT_NEAR(volumeAt_ml(motion, 0.36), kPublished_ml[9], 0.1);
}

// Smooth kinds through two uneven instants overshoot, which is told; the cycle and lines do not.
TEST(CycleInterpolationLaw, WhatLeavesItsKeyframesVolumesIsTold) {
  if (!std::filesystem::exists(kReal)) GTEST_SKIP() << "no real data beside the project";
  for (const Interpolation kind : {Interpolation::linear, Interpolation::cycle}) {
    const Scene scene = twoPhases(kind);
    EXPECT_TRUE(motionWarnings(scene, MeshMotion(scene)).empty());
  }
  const Scene scene = twoPhases(Interpolation::catmull_rom);
  const std::vector<std::string> told = motionWarnings(scene, MeshMotion(scene));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find(": lv: frame "), std::string::npos) << told[0];
  EXPECT_NE(told[0].find(" mL over both adjacent keyframes, "), std::string::npos) << told[0];
  EXPECT_TRUE(
      told[0].ends_with("motion.interpolation = \"cycle\" or \"linear\" stays between them"))
      << told[0];
}

// A beat that is closed by its first frame again says so; one whose frames differ does not.
TEST(CycleInterpolationLaw, ALastKeyframeEqualToTheFirstIsTold) {
  const TestFolder folder;
  Scene scene = beatingBall(folder, {2, 1.9, 1.8, 1.7, 1.8, 1.9, 2}, 1);
  scene.motion.interpolation = Interpolation::linear;
  const std::vector<std::string> told = motionWarnings(scene, MeshMotion(scene));
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("drop the frame that closes the beat"), std::string::npos) << told[0];
}

}  // namespace
}  // namespace echocine::motion_test
