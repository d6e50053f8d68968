// Left-out keyframes of balls whose radius is a cosine, against closed forms.

#include "motion/keyframes/interpolation_judge.h"

#include <numbers>

#include "motion/surfaces/mesh_motion.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

constexpr double kPi = std::numbers::pi;

MeshMotion ballOf(const TestFolder& folder, const std::vector<double>& radii_cm,
                  bool membrane = false) {
  Scene scene = beatingBall(folder, radii_cm, 0);
  scene.structures[0].membrane = membrane;
  return MeshMotion(scene);
}

std::vector<double> cosineRadii(int keyframes) {
  std::vector<double> radii_cm;
  for (int k = 0; k < keyframes; ++k)
    radii_cm.push_back(2 + 0.5 * std::cos(2 * kPi * k / keyframes));
  return radii_cm;
}

InterpolationError interpolationErrorOf(const MeshMotion& motion, Interpolation kind) {
  const auto error = judgeInterpolation(motion.control(SurfaceId{}), kind);
  EXPECT_TRUE(error.has_value());
  return error.value_or(InterpolationError{});
}

// What a kind makes of cos(t) halfway between keyframes at distance step: cos(t) times this.
double halfwayFactor(Interpolation kind, double step) {
  const double c = std::cos(step), half = std::cos(step / 2);
  switch (kind) {
    case Interpolation::linear:
      return half;
    case Interpolation::catmull_rom:
      return (9 * half - std::cos(1.5 * step)) / 8;
    case Interpolation::spline:
      return half * (1 + 0.75 * (1 - c) / (2 + c));
    case Interpolation::fourier:
      return 1;
    case Interpolation::cycle:
      break;  // no heart's beat is a cosine
  }
  return 0;
}

// Every vertex of the octahedron is at the radius, which is 2 cm + 0.5 cm cos.
TEST(MotionInterpolationJudge, CosineRadiusHasTheClosedFormErrors) {
  const TestFolder folder;
  const MeshMotion motion = ballOf(folder, cosineRadii(16));
  for (const Interpolation kind : kInterpolations) {
    if (kind == Interpolation::cycle) continue;
    const double lost_m = 0.005 * (1 - halfwayFactor(kind, kPi / 4));
    const InterpolationError e = interpolationErrorOf(motion, kind);
    EXPECT_EQ(e.kept, 8u);
    EXPECT_EQ(e.left_out, 8u);
    EXPECT_EQ(e.vertices, 48u);
    EXPECT_EQ(e.volumes, 8u);
    EXPECT_NEAR(e.vertex_rms_m, std::abs(lost_m) / std::sqrt(2.0), 1e-8);
    EXPECT_NEAR(e.vertex_max_m, std::abs(lost_m) * std::cos(kPi / 8), 1e-8);
    const double truth_m = 0.02 + 0.005 * std::cos(kPi / 8);
    const double found_m = truth_m - lost_m * std::cos(kPi / 8);
    const double most_m3 = 4.0 / 3 * std::pow(0.025, 3);
    const double worst_m3 = 4.0 / 3 * std::abs(std::pow(truth_m, 3) - std::pow(found_m, 3));
    EXPECT_NEAR(e.largest_volume_m3, most_m3, 1e-5 * most_m3);
    EXPECT_NEAR(e.volume_max_m3, worst_m3, 1e-5 * most_m3);
    EXPECT_NEAR(e.volume_max_share, worst_m3 / most_m3, 1e-5);
    EXPECT_LE(e.volume_rms_m3, e.volume_max_m3);
  }
}

// Keyframes 0, 2 and 4 of five stay at 0, 0.4 and 0.8: the last gap is 0.2. Left out are 1 and 3.
TEST(MotionInterpolationJudge, OddNumberKeepsBothEndsAndItsUnevenGap) {
  const TestFolder folder;
  const MeshMotion motion = ballOf(folder, {2.0, 2.5, 2.2, 1.5, 1.6});
  const InterpolationError e = interpolationErrorOf(motion, Interpolation::linear);
  EXPECT_EQ(e.kept, 3u);
  EXPECT_EQ(e.left_out, 2u);
  EXPECT_NEAR(e.vertex_rms_m, std::hypot(0.004, 0.004) / std::sqrt(2.0), 1e-8);  // 2.1, 1.9 cm
  std::vector<double> weights(3);
  KeyframeWeights(std::vector{0.0, 0.4, 0.8}, Interpolation::spline).at(0.2, weights);
  const double spline_cm = 2.0 * weights[0] + 2.2 * weights[1] + 1.6 * weights[2];
  KeyframeWeights(std::vector{0.0, 0.4, 0.8}, Interpolation::spline).at(0.6, weights);
  const double later_cm = 2.0 * weights[0] + 2.2 * weights[1] + 1.6 * weights[2];
  EXPECT_NEAR(interpolationErrorOf(motion, Interpolation::spline).vertex_max_m,
              0.01 * std::max(std::abs(spline_cm - 2.5), std::abs(later_cm - 1.5)), 1e-8);
}

TEST(MotionInterpolationJudge, WhatDoesNotMoveIsFoundByEveryKind) {
  const TestFolder folder;
  const MeshMotion motion = ballOf(folder, {2, 2, 2, 2, 2});
  for (const Interpolation kind : kInterpolations) {
    EXPECT_LT(interpolationErrorOf(motion, kind).vertex_max_m, 1e-8);
    EXPECT_LT(interpolationErrorOf(motion, kind).volume_max_share, 1e-6);
  }
}

TEST(MotionInterpolationJudge, MembraneHasNoVolumes) {
  const TestFolder folder;
  const InterpolationError e =
      interpolationErrorOf(ballOf(folder, cosineRadii(8), true), Interpolation::spline);
  EXPECT_GT(e.vertex_rms_m, 0);
  EXPECT_EQ(e.volumes, 0u);
  EXPECT_EQ(e.volume_max_share, 0);
}

TEST(MotionInterpolationJudge, ThreeKeyframesAndRefusedSpacingsAreNotJudged) {
  const TestFolder folder;
  EXPECT_FALSE(judgeInterpolation(ballOf(folder, {2, 2.1, 2.2}).control(SurfaceId{}),
                                  Interpolation::linear));
  Scene bunched = beatingBall(folder, cosineRadii(24), 0);
  bunched.motion.interpolation = Interpolation::linear;
  for (std::size_t k = 0; k < 24; ++k)
    bunched.structures[0].keyframes[k].phase = 0.03 * static_cast<double>(k);
  const MeshMotion motion(bunched);
  EXPECT_TRUE(judgeInterpolation(motion.control(SurfaceId{}), Interpolation::spline));
  EXPECT_FALSE(judgeInterpolation(motion.control(SurfaceId{}), Interpolation::fourier));
}

TEST(MotionInterpolationJudge, PooledErrorsWeighVerticesAndVolumes) {
  InterpolationError a, b;
  a.vertices = 300, a.vertex_rms_m = 1, a.vertex_max_m = 2;
  a.volumes = 1, a.volume_rms_m3 = a.volume_max_m3 = 3, a.volume_max_share = 0.3;
  b.vertices = 100, b.vertex_rms_m = 3, b.vertex_max_m = 7;
  b.volumes = 3, b.volume_rms_m3 = 1, b.volume_max_m3 = 2, b.volume_max_share = 0.5;
  const InterpolationError all = pooled(std::vector{a, b});
  EXPECT_NEAR(all.vertex_rms_m, std::sqrt(3.0), 1e-12);
  EXPECT_EQ(all.vertex_max_m, 7);
  EXPECT_NEAR(all.volume_rms_m3, std::sqrt(3.0), 1e-12);
  EXPECT_EQ(all.volume_max_m3, 3);
  EXPECT_EQ(all.volume_max_share, 0.5);
}

}  // namespace
}  // namespace echocine::motion_test
