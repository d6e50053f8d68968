// Loop subdivision against its masks, worked by hand.

#include "motion/subdivision/subdivision.h"

#include "motion/mesh/mesh_check.h"
#include "tests/stage/crease_fixtures.h"

namespace echocine::motion_test {
namespace {

bool hasVertex(const TriangleMesh& mesh, Vec3d p) {
  for (const Vec3d& q : mesh.positions)
    if (length(q - p) < 1e-6) return true;
  return false;
}

// Loop's masks by hand: 3/8 and 1/8 for an edge, beta of each neighbour for a vertex.
TEST(MotionSubdivision, OctahedronFollowsLoopsMasks) {
  const TriangleMesh fine = refined(octahedron(1), 1);
  EXPECT_EQ(fine.positions.size(), 18u);
  EXPECT_EQ(fine.triangles.size(), 32u);
  // Valence 4: beta = (5/8 - (3/8 + cos(2 pi/4)/4)^2) / 4, and the neighbours' sum is 0.
  const double beta = (5.0 / 8 - 9.0 / 64) / 4;
  EXPECT_TRUE(hasVertex(fine, {1 - 4 * beta, 0, 0}));
  // Edge x - y, opposite corners z and -z: 3/8 (x + y).
  EXPECT_TRUE(hasVertex(fine, {3.0 / 8, 3.0 / 8, 0}));
}

TEST(MotionSubdivision, KeepsSurfacesClosedAndLookingOutward) {
  for (int levels = 1; levels <= 3; ++levels) {
    const TriangleMesh fine = refined(octahedron(1), levels);
    EXPECT_EQ(fine.triangles.size(), 8u << (2 * levels));
    EXPECT_EQ(leakCount(fine.triangles), 0u);
    EXPECT_GT(signedVolume(fine), 0.2);
    EXPECT_LT(signedVolume(fine), 4.0 / 3);
  }
}

// Affine invariance: moving the control mesh moves the surface alike.
TEST(MotionSubdivision, RowsSumToOneSoShapesMoveWithTheirControlVertices) {
  const Vec3d shift{3, -2, 5};
  TriangleMesh moved = sphere(1, 1);
  const TriangleMesh here = refined(moved, 2);
  for (Vec3d& p : moved.positions) p = p + shift;
  const TriangleMesh there = refined(moved, 2);
  for (std::size_t v = 0; v < here.positions.size(); ++v)
    EXPECT_LT(length(there.positions[v] - here.positions[v] - shift), 5e-6);
}

TEST(MotionSubdivision, BoundaryOfASheetFollowsItsOwnVerticesOnly) {
  TriangleMesh roof;  // two triangles; lifting the far corner must not move the other two edges
  roof.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {4, 4, 7}};
  roof.triangles = {{0, 1, 2}, {1, 3, 2}};
  const TriangleMesh fine = refined(roof, 1);
  EXPECT_TRUE(hasVertex(fine, {2, 0, 0}));        // middle of an open edge
  EXPECT_TRUE(hasVertex(fine, {0.5, 0.5, 0}));    // (1, 6, 1)/8 along the boundary
  EXPECT_TRUE(hasVertex(fine, {2, 2, 7.0 / 8}));  // inner edge: 3/8, 3/8, 1/8, 1/8
  EXPECT_EQ(fine.triangles.size(), 8u);
}

TEST(MotionSubdivision, TooManyTrianglesAreRefusedAtTheirPlace) {
  const TriangleMesh ball = octahedron(1);
  EXPECT_EQ(errorOf([&] {
              Subdivision(ball.triangles, 6, {}, 12, {"scene.toml", 4, "motion.subdivision"});
            }),
            "scene.toml:4: motion.subdivision: 12 levels make more than 50000000 triangles of this "
            "mesh's 8; use fewer levels");
}

}  // namespace
}  // namespace echocine::motion_test
