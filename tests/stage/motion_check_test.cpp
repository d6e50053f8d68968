// Triangles and surfaces that break between keyframes, and motions that must raise no alarm.

#include "motion/keyframes/motion_check.h"

#include <numbers>

#include "core/parallel.h"
#include "motion/keyframes/keyframe_pair.h"
#include "motion/surfaces/mesh_motion.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

std::vector<FramePhase> evenFrames(int count) {
  std::vector<FramePhase> frames;
  for (int i = 0; i < count; ++i) frames.push_back({i, static_cast<double>(i) / count});
  return frames;
}

SurfaceBreaks breaksOf(const std::vector<TriangleMesh>& keyframes, Interpolation kind,
                       const std::vector<FramePhase>& frames, bool membrane = false) {
  const TestFolder folder;
  Scene scene = sceneWith(folder, keyframes, kind);
  scene.structures[0].membrane = membrane;
  const MeshMotion motion(scene);
  const ControlMotion& control = motion.control(SurfaceId{});
  const SurfaceBreaks breaks = findBreaks(control, frames);
  const std::optional<SurfaceBreaks::Size> inside_out = findInsideOut(control, frames);
  EXPECT_EQ(inside_out.has_value(), breaks.inside_out.has_value());
  if (inside_out && breaks.inside_out) {
    EXPECT_EQ(inside_out->frame, breaks.inside_out->frame);
    EXPECT_EQ(inside_out->volume_m3, breaks.inside_out->volume_m3);
  }
  return breaks;
}

TriangleMesh tetrahedron() {
  return {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
          {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

TriangleMesh turned(TriangleMesh mesh, double degrees) {
  const double c = std::cos(degrees * std::numbers::pi / 180),
               s = std::sin(degrees * std::numbers::pi / 180);
  for (Vec3d& p : mesh.positions) p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
  return mesh;
}

std::vector<TriangleMesh> turning(const TriangleMesh& mesh, double step_degrees, int keyframes) {
  std::vector<TriangleMesh> list;
  for (int k = 0; k < keyframes; ++k) list.push_back(turned(mesh, k * step_degrees));
  return list;
}

void expectWhole(const SurfaceBreaks& breaks) {
  EXPECT_FALSE(breaks.first) << "triangle " << breaks.first->triangle << " frame "
                             << breaks.first->frame;
  EXPECT_EQ(breaks.triangles, 0u);
  EXPECT_FALSE(breaks.collapsed) << breaks.collapsed->share;
  EXPECT_FALSE(breaks.inside_out);
}

constexpr double kApothem = 1.8477590650225735;                   // 2 cos(22.5 degrees)
const Vec3d kOutward{0.9238795325112867, 0.3826834323650898, 0};  // to the middle of side 0

TEST(MotionCheck, QuarterTurnsBetweenKeyframesAreFine) {
  for (const Interpolation kind : kInterpolations)
    for (const TriangleMesh& mesh : {tetrahedron(), octahedron(2), sphere(2, 2), cake(kMiddle)}) {
      expectWhole(breaksOf(turning(mesh, 90, 4), kind, evenFrames(103)));
      expectWhole(breaksOf({mesh, turned(mesh, 90)}, kind, evenFrames(103)));
    }
}

TEST(MotionCheck, ALeafletThatSwingsByAQuarterTurnIsFine) {
  TriangleMesh leaflet;  // hinged on the z axis, swung about it
  for (int i = 0; i <= 4; ++i)
    for (int j = 0; j <= 4; ++j) leaflet.positions.push_back({0.5 * i, 0, 0.5 * j});
  for (std::uint32_t i = 0; i < 4; ++i)
    for (std::uint32_t j = 0; j < 4; ++j) {
      const std::uint32_t a = 5 * i + j;
      leaflet.triangles.insert(leaflet.triangles.end(), {{a, a + 5, a + 6}, {a, a + 6, a + 1}});
    }
  for (const Interpolation kind : kInterpolations)
    expectWhole(breaksOf({leaflet, turned(leaflet, 90), turned(leaflet, 80), turned(leaflet, 10)},
                         kind, evenFrames(101), true));
}

// The blend of p and its image is cos(0) = 1 along the axis and 1 - 2 s across it: the share of the
// volume is (1 - 2 s)^2.
TEST(MotionCheck, HalfATurnCollapsesUnderLinearBlending) {
  const std::vector<TriangleMesh> keyframes = turning(sphere(2, 2), 180, 2);
  const SurfaceBreaks breaks = breaksOf(keyframes, Interpolation::linear, evenFrames(22));
  ASSERT_TRUE(breaks.collapsed);
  EXPECT_EQ(breaks.collapsed->frame, 5);
  EXPECT_NEAR(breaks.collapsed->share, std::pow(1 - 20.0 / 22, 2), 1e-5);
  EXPECT_FALSE(breaks.inside_out);
  EXPECT_FALSE(
      breaksOf(turning(sphere(2, 2), 110, 2), Interpolation::linear, evenFrames(22)).collapsed);
}

TEST(MotionCheck, CollapseOfAMembraneIsToldByItsArea) {
  TriangleMesh sheet{{{0, 0, 0}, {1, 0, 0}, {0, 0, 2}}, {{0, 1, 2}}};
  const SurfaceBreaks breaks =
      breaksOf({sheet, turned(sheet, 180)}, Interpolation::linear, {{7, 0.24}}, true);
  ASSERT_TRUE(breaks.collapsed);
  EXPECT_EQ(breaks.collapsed->frame, 7);
  EXPECT_NEAR(breaks.collapsed->share, 0.04, 1e-5);
  EXPECT_EQ(breaks.collapsed->volume_m3, 0);
}

// The middle of the fan goes over the rim's side 0, at x = 2 cos(22.5 degrees) = 1.85; with a
// heart's pace it does so at 0.48 to 0.5 of the beat, in rapid filling.
TEST(MotionCheck, ATriangleThatMirrorsIsNamed) {
  const Vec3d beyond = kMiddle + 2.2 * kOutward;
  const std::vector<TriangleMesh> keyframes{cake(kMiddle), cake(kMiddle), cake(beyond),
                                            cake(beyond)};
  for (const Interpolation kind : kInterpolations) {
    const SurfaceBreaks breaks = breaksOf(keyframes, kind, evenFrames(320));
    ASSERT_TRUE(breaks.first);
    EXPECT_EQ(breaks.first->triangle, 0u);
    EXPECT_EQ(breaks.first->kind, TriangleBreak::mirrored);
    EXPECT_EQ(breaks.first->left, 1u);
    EXPECT_EQ(breaks.first->right, 2u);
    EXPECT_GT(breaks.first->frame, 80);
    EXPECT_LT(breaks.first->frame, 160);
    EXPECT_FALSE(breaks.inside_out);
  }
}

TEST(MotionCheck, OnlyFramesBehindTheMirrorAreBroken) {
  const Vec3d beyond = kMiddle + 2.2 * kOutward;
  const std::vector<TriangleMesh> keyframes{cake(kMiddle), cake(beyond)};
  expectWhole(breaksOf(keyframes, Interpolation::linear, {{3, 0.35}}));  // 0.7 of the way: inside
  const SurfaceBreaks breaks =
      breaksOf(keyframes, Interpolation::linear, {{3, 0.35}, {4, 0.46}, {5, 0.5}});
  ASSERT_TRUE(breaks.first);
  EXPECT_EQ(breaks.first->frame, 4);
  EXPECT_EQ(breaks.triangles, 1u);
}

// Exactly at the rim it has no area.
TEST(MotionCheck, ATriangleWithoutAreaIsNamed) {
  const std::vector<TriangleMesh> keyframes{cake(kMiddle), cake(kMiddle + 2 * kApothem * kOutward)};
  const SurfaceBreaks breaks = breaksOf(keyframes, Interpolation::linear, {{9, 0.25}});
  ASSERT_TRUE(breaks.first);
  EXPECT_EQ(breaks.first->triangle, 0u);
  EXPECT_EQ(breaks.first->kind, TriangleBreak::vanished);
  EXPECT_EQ(breaks.triangles, 1u);
}

// 0, 0, 1.75, 1.75 towards the rim at 1.85: between the last two a smooth curve swings beyond it.
TEST(MotionCheck, OvershootThatFoldsIsNamedAndLinearIsFine) {
  const Vec3d near_rim = kMiddle + 1.75 * kOutward;
  const std::vector<TriangleMesh> keyframes{cake(kMiddle), cake(kMiddle), cake(near_rim),
                                            cake(near_rim)};
  expectWhole(breaksOf(keyframes, Interpolation::linear, evenFrames(160)));
  for (const Interpolation kind : {Interpolation::catmull_rom, Interpolation::spline}) {
    const SurfaceBreaks breaks = breaksOf(keyframes, kind, evenFrames(160));
    ASSERT_TRUE(breaks.first);
    EXPECT_EQ(breaks.first->triangle, 0u);
    EXPECT_EQ(breaks.first->left, 2u);
    EXPECT_NE(breaks.first->kind, TriangleBreak::mirrored);
    EXPECT_EQ(breaks.triangles, 1u);
  }
}

// Radii 2, 2, 0.05, 0.05: halfway between the small ones Catmull and Rom give -0.19 of a ball.
TEST(MotionCheck, OvershootThroughTheMiddleIsInsideOut) {
  const std::vector<TriangleMesh> keyframes{octahedron(2), octahedron(2), octahedron(0.06),
                                            octahedron(0.06)};
  const SurfaceBreaks breaks =
      breaksOf(keyframes, Interpolation::catmull_rom, {{1, 0.3}, {6, 0.625}, {7, 0.63}});
  ASSERT_TRUE(breaks.inside_out);
  EXPECT_EQ(breaks.inside_out->frame, 6);
  const double radius_m = 0.01 * (9.0 / 8 * 0.06 - 2.0 / 8);
  EXPECT_NEAR(breaks.inside_out->volume_m3, 4.0 / 3 * std::pow(radius_m, 3), 1e-12);
  expectWhole(breaksOf(keyframes, Interpolation::linear, evenFrames(50)));
}

TEST(MotionCheck, FramesAtKeyframesAndFoldsInAllKeyframesAreAsRead) {
  const Vec3d beyond = kMiddle + 2.2 * kOutward;
  expectWhole(breaksOf({cake(kMiddle), cake(beyond)}, Interpolation::spline, evenFrames(2)));
  expectWhole(breaksOf({cake(beyond), cake(beyond)}, Interpolation::spline, evenFrames(30)));
}

TEST(MotionCheck, CreasesOfAMembraneAreFine) {
  TriangleMesh crease{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}}};
  TriangleMesh folded = crease;
  folded.positions[3] = {0.1, 0.1, 0.01};
  expectWhole(breaksOf({crease, folded}, Interpolation::linear, {{0, 0.45}}, true));
}

TEST(MotionCheck, SliversHaveNoSideToTurn) {
  TriangleMesh thin = cake(kMiddle), other = thin;  // a needle that turns over
  for (TriangleMesh* mesh : {&thin, &other}) {
    const auto base = static_cast<std::uint32_t>(mesh->positions.size());
    mesh->positions.insert(mesh->positions.end(), {{0, 0, 3}, {1, 0, 3}, {0.5, 1e-5, 3}});
    mesh->triangles.push_back({base, base + 1, base + 2});
    mesh->triangles.push_back({base, base + 2, base + 1});
  }
  other.positions.back().y = -1e-5;
  expectWhole(breaksOf({thin, other}, Interpolation::linear, evenFrames(40)));
}

TEST(MotionCheck, ThreadsDoNotChangeTheResult) {
  const std::vector<TriangleMesh> keyframes = turning(sphere(2, 2), 170, 9);
  SurfaceBreaks one, four;
  withThreads(1, [&] { one = breaksOf(keyframes, Interpolation::spline, evenFrames(200)); });
  withThreads(4, [&] { four = breaksOf(keyframes, Interpolation::spline, evenFrames(200)); });
  ASSERT_TRUE(one.collapsed && four.collapsed);
  EXPECT_EQ(one.triangles, four.triangles);
  EXPECT_EQ(one.collapsed->frame, four.collapsed->frame);
  EXPECT_EQ(one.collapsed->share, four.collapsed->share);
  EXPECT_EQ(one.first.has_value(), four.first.has_value());
}

TEST(MotionCheck, NeighboursShareAnEdge) {
  const std::vector<Neighbours> pairs = neighboursOf(octahedron(1).triangles);
  EXPECT_EQ(pairs.size(), 12u);
  EXPECT_TRUE(neighboursOf(TriangleMesh{{}, {{0, 1, 2}}}.triangles).empty());
}

}  // namespace
}  // namespace echocine::motion_test
