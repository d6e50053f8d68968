// The measuring tools of the tests themselves.

#include "support/rigid_fit.h"

#include <gtest/gtest.h>

#include "support/recorded_heart.h"

namespace echocine {
namespace {

using namespace support;

TEST(RigidFit, FindsAKnownMotionAgain) {
  const double c = std::cos(0.9), s = std::sin(0.9);
  const RigidMotion known{{Vec3d{c, -s, 0}, Vec3d{s, c, 0}, Vec3d{0, 0, 1}}, {3, -4, 5}};
  const Mesh ball = icosphere(1, 2).moved({1, 0, 7});
  std::vector<Vec3d> moved;
  for (const Vec3d p : ball.points) moved.push_back(known.of(p));
  const RigidMotion found = rigidFit(ball.points, moved);
  for (const Vec3d p : ball.points) EXPECT_LT(length(found.of(p) - known.of(p)), 1e-9);
}

TEST(RigidFit, NearestPointsLieOnFacesEdgesAndCorners) {
  const Mesh cube = box({0, 0, 0}, {2, 2, 2});
  const auto expectNear = [&](Vec3d p, Vec3d q) {
    EXPECT_LT(length(nearestOn(cube, p) - q), 1e-12);
  };
  expectNear({1.3, 0.4, 5}, {1.3, 0.4, 2});
  expectNear({3, 1.1, 3}, {2, 1.1, 2});
  expectNear({-1, -2, -3}, {0, 0, 0});
  expectNear({1, 1.2, 0.1}, {1, 1.2, 0});
}

TEST(MeshMeasures, VolumeAndWindingOfABoxAreItsOwn) {
  const Mesh cube = box({1, 1, 1}, {2, 3, 4});
  EXPECT_NEAR(fluxVolume(cube), 6, 1e-12);
  EXPECT_NEAR(fluxVolume(cube.insideOut()), -6, 1e-12);
  EXPECT_NEAR(windingNumber(cube, {1.2, 2.7, 3.9}), 1, 1e-12);
  EXPECT_NEAR(windingNumber(cube, {0.9, 2, 3}), 0, 1e-12);
}

}  // namespace
}  // namespace echocine
