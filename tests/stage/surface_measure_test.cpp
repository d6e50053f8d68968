// Volumes by pairs of triangles next to the plain sum.

#include "motion/mesh/surface_measure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {
namespace {

std::vector<Vec3f> floatsOf(const std::vector<Vec3d>& points) {
  std::vector<Vec3f> floats;
  for (const Vec3d& p : points) floats.push_back(toFloat(p));
  return floats;
}

// However the triangles are listed and wherever each begins: all paired, some or none.
TEST(VolumeSum, IsTheSumOverTrianglesInAnyOrder) {
  std::mt19937 random(7);
  for (const Vec3d middle : {Vec3d{0, 0, 0}, Vec3d{0.3, -0.2, 8}}) {
    TriangleMesh mesh = sphere(0.03, 3);
    for (Vec3d& p : mesh.positions) p = p + middle;
    const std::vector<Vec3f> positions = floatsOf(mesh.positions);
    for (int order = 0; order < 20; ++order) {
      EXPECT_NEAR(
          VolumeSum(mesh.triangles).of(positions) / enclosedVolume(mesh.triangles, positions), 1,
          1e-12);
      std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), random);
      for (Triangle& t : mesh.triangles) std::rotate(t.begin(), t.begin() + random() % 3, t.end());
    }
  }
}

TEST(VolumeSum, OctahedronIsExact) {
  const TriangleMesh mesh = octahedron(2);
  EXPECT_DOUBLE_EQ(VolumeSum(mesh.triangles).of(floatsOf(mesh.positions)), 4.0 / 3 * 8);
  EXPECT_EQ(VolumeSum().of({}), 0);
}

}  // namespace
}  // namespace echocine::motion_test
