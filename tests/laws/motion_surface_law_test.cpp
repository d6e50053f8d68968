// What holds for every frame of a moving surface.

#include <filesystem>
#include <numbers>

#include "motion/surfaces/mesh_motion.h"
#include "scene/scene_reader.h"
#include "support/paths.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

// Radii of a ball that contracts by a third, cm.
std::vector<double> beat(int keyframes) {
  std::vector<double> radii_cm;
  for (int k = 0; k < keyframes; ++k)
    radii_cm.push_back(2.5 + 0.5 * std::cos(2 * std::numbers::pi * k / keyframes));
  return radii_cm;
}

double volumeAt(const MeshMotion& motion, double phase) {
  SurfaceFrame frame;
  motion.frameAt(phase, frame);
  return enclosedVolume(motion.surfaces()[0], frame.positions_m[0]);
}

// Interpolation passes through what was recorded.
TEST(MotionSurfaceLaw, KeyframePhasesReproduceTheirKeyframes) {
  const TestFolder folder;
  for (const Interpolation kind : kInterpolations) {
    Scene scene = beatingBall(folder, beat(7), 1);
    scene.motion.interpolation = kind;
    const MeshMotion motion(scene);
    SurfaceFrame frame;
    for (int k = 0; k < 7; ++k) {
      motion.frameAt(scene.structures[0].keyframes[static_cast<std::size_t>(k)].phase, frame);
      const TriangleMesh exact = sphere(beat(7)[static_cast<std::size_t>(k)], 1);
      for (std::size_t v = 0; v < exact.positions.size(); ++v)
        ASSERT_EQ(frame.positions_m[0][v], toFloat(0.01 * exact.positions[v]));
    }
  }
}

// Some surfaces of the shipped heart, moving and still ones, against all of them. The others stay.
TEST(MotionSurfaceLaw, SomeSurfacesHaveTheBitsOfAllOfThem) {
  const Scene scene =
      readScene(std::filesystem::path(support::kSourceDir) / "examples/beating_heart/scene.toml");
  const MeshMotion motion(scene);
  std::vector<SurfaceId> some;
  for (const SurfaceTopology& surface : motion.surfaces())
    if (index(surface.id) % 3 == 0) some.push_back(surface.id);
  SurfaceFrame all, few;
  for (const double phase : {0.0, 0.123, 0.36, 0.9}) {
    motion.frameAt(phase, all, false);
    motion.positionsAt(phase, some, few);
    for (std::size_t s = 0; s < all.positions_m.size(); ++s)
      EXPECT_EQ(few.positions_m[s], s % 3 == 0 ? all.positions_m[s] : std::vector<Vec3f>{});
  }
}

// Phase 1 is phase 0 of the next beat.
TEST(MotionSurfaceLaw, TheCycleClosesWithoutAJump) {
  const TestFolder folder;
  for (const Interpolation kind : kInterpolations) {
    Scene scene = beatingBall(folder, beat(6), 1);
    scene.motion.interpolation = kind;
    const MeshMotion motion(scene);
    SurfaceFrame first, last;
    motion.frameAt(0, first);
    motion.frameAt(std::nextafter(1.0, 0.0), last);
    for (std::size_t v = 0; v < first.positions_m[0].size(); ++v)
      EXPECT_LT(length(first.positions_m[0][v] - last.positions_m[0][v]), 1e-8f);
  }
}

// Hits and material points are named by faces, and inside is told by closed surfaces.
TEST(MotionSurfaceLaw, FacesNeverChangeAndSurfacesStayClosed) {
  const TestFolder folder;
  for (int levels = 0; levels <= 2; ++levels) {
    Scene scene = beatingBall(folder, beat(5), 1);
    scene.motion.subdivision = levels;
    const MeshMotion motion(scene);
    const SurfaceTopology& surface = motion.surfaces()[0];
    EXPECT_EQ(surface.triangles.size(), 32u << (2 * levels));
    EXPECT_EQ(leakCount(surface.triangles), 0u);
    SurfaceFrame frame;
    for (double phase = 0; phase < 1; phase += 0.037) {
      motion.frameAt(phase, frame);
      ASSERT_EQ(frame.positions_m[0].size(), surface.vertex_count);
      for (const Vec3f& p : frame.positions_m[0]) ASSERT_TRUE(isFinite(toDouble(p)));
    }
  }
}

// Interpolating vertices of similar shapes interpolates the radius, so the volume is its cube.
TEST(MotionSurfaceLaw, VolumeIsTheCubeOfTheInterpolatedRadius) {
  const TestFolder folder;
  Scene scene = beatingBall(folder, beat(9), 2);
  scene.motion.interpolation = Interpolation::fourier;  // exact for this motion
  const MeshMotion motion(scene);
  const double unit_volume = volumeAt(motion, 0) / std::pow(0.03, 3);
  for (double phase = 0; phase < 1; phase += 0.0173) {
    const double radius_m = 0.025 + 0.005 * std::cos(2 * std::numbers::pi * phase);
    EXPECT_NEAR(volumeAt(motion, phase) / (unit_volume * std::pow(radius_m, 3)), 1.0, 1e-6);
  }
}

TEST(MotionSurfaceLaw, VolumeOfARefinedSphereTendsToTheBall) {
  const TestFolder folder;
  double error = 1;
  for (int level = 1; level <= 5; ++level) {
    const MeshMotion motion(beatingBall(folder, {3}, level));
    const double ball = 4.0 / 3.0 * std::numbers::pi * std::pow(0.03, 3);
    const double next = 1 - volumeAt(motion, 0) / ball;
    EXPECT_GT(next, 0);
    if (level > 2) {
      EXPECT_NEAR(error / next, 4.0, 0.3);  // second order in the edge length
    }
    error = next;
  }
}

// The unit is a scale and nothing else, and a shift of world and probe together is nothing at all.
TEST(MotionSurfaceLaw, UnitAndPlaceOfTheWorldDoNotMatter) {
  const TestFolder folder;
  Scene centimetres = beatingBall(folder, beat(5), 1);
  Scene millimetres = centimetres, shifted = centimetres;
  millimetres.motion.mesh_unit_m = 0.001;
  shifted.probe.pose.origin = {10, -10, 10};
  for (std::size_t k = 0; k < 5; ++k) {
    TriangleMesh large = sphere(10 * beat(5)[k], 1), moved = sphere(beat(5)[k], 1);
    for (Vec3d& p : moved.positions) p = p + Vec3d{1000, -1000, 1000};
    const std::string number = std::to_string(k);
    millimetres.structures[0].keyframes[k].files = {
        folder.write("mm" + number + ".obj", objText(large))};
    shifted.structures[0].keyframes[k].files = {
        folder.write("far" + number + ".obj", objText(moved))};
  }
  SurfaceFrame a, b, c;
  MeshMotion(centimetres).frameAt(0.3, a);
  MeshMotion(millimetres).frameAt(0.3, b);
  MeshMotion(shifted).frameAt(0.3, c);
  for (std::size_t v = 0; v < a.positions_m[0].size(); ++v) {
    EXPECT_LT(length(a.positions_m[0][v] - b.positions_m[0][v]), 1e-8f);
    EXPECT_LT(length(a.positions_m[0][v] - c.positions_m[0][v]), 1e-8f);
  }
}

}  // namespace
}  // namespace echocine::motion_test
