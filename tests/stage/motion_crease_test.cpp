// Creases and corners against the curves and shapes they must keep.

#include "motion/mesh/mesh_check.h"
#include "tests/stage/crease_fixtures.h"

namespace echocine::motion_test {
namespace {

TEST(MotionCrease, ACubeOfSharpEdgesStaysACube) {
  for (const bool corners : {true, false}) {
    TriangleMesh cube = creasedCube();
    if (!corners) cube.tags.vertices.clear();  // three creases at a vertex make it a corner too
    for (int levels = 1; levels <= 4; ++levels) {
      const TriangleMesh fine = refined(cube, levels);
      EXPECT_NEAR(signedVolume(fine), 8, 1e-5);
      EXPECT_EQ(leakCount(fine.triangles), 0u);
      for (const Vec3d& p : cube.positions) EXPECT_EQ(distanceTo(fine, p), 0);
      for (const Vec3d& p : fine.positions) {
        const double outermost = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        EXPECT_NEAR(outermost, 1, 3e-7);  // float rounding
      }
    }
    cube.tags = {};
    EXPECT_LT(signedVolume(refined(cube, 3)), 4);  // what the tags are for
  }
}

// Cubic B-spline subdivision of a closed polygon in double precision: the oracle of rims.
std::vector<Vec3d> splineRefined(std::vector<Vec3d> points, int levels) {
  for (int level = 0; level < levels; ++level) {
    std::vector<Vec3d> fine;
    const std::size_t n = points.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d before = points[(i + n - 1) % n], here = points[i], after = points[(i + 1) % n];
      fine.push_back(0.125 * before + 0.75 * here + 0.125 * after);
      fine.push_back(0.5 * here + 0.5 * after);
    }
    points = fine;
  }
  return points;
}

TEST(MotionCrease, RimsOfACylinderAreTheSplinesOfTheirPolygons) {
  constexpr std::uint32_t n = 12;
  const TriangleMesh sharp = cylinder(n, 4, kInfiniteSharpness), smooth = cylinder(n, 4, 0);
  const std::vector<Vec3d> rim(sharp.positions.end() - 2 - n, sharp.positions.end() - 2);
  for (int levels = 1; levels <= 4; ++levels) {
    const TriangleMesh fine = refined(sharp, levels), round = refined(smooth, levels);
    const std::vector<Vec3d> curve = splineRefined(rim, levels);
    for (const Vec3d& p : curve) {
      EXPECT_LT(distanceTo(fine, p), 1e-6);
      EXPECT_GT(distanceTo(round, p), 0.02);
    }
    // Closed form: (1, 4, 1)/6 is the curve's point at a control vertex; the polygon's second
    // difference there falls by 4 a level.
    const double limit_radius = (2 + std::cos(2 * std::numbers::pi / n)) / 3;
    EXPECT_NEAR(length(curve[0] - Vec3d{0, 0, 1}), limit_radius, 0.05 * std::pow(0.25, levels));
    double top = 0;
    for (const Vec3d& p : fine.positions) top = std::max(top, p.z);
    EXPECT_NEAR(top, 1, 1e-6);
  }
}

// A cup and a lid, both closed, whose common rim is the same ring of points under other numbers.
TEST(MotionCrease, StructuresThatShareACreasedRingShareItAfterwards) {
  constexpr std::uint32_t n = 10;
  const TriangleMesh cup = cylinder(n, 3, kInfiniteSharpness);
  TriangleMesh lid = cylinder(n, 2, kInfiniteSharpness);
  for (std::uint32_t s = 0; s < n; ++s) lid.positions[s] = cup.positions[2 * n + s];
  for (std::uint32_t s = 0; s < n; ++s) lid.positions[n + s] = {0.5, 0.1 * s, 3};
  lid.positions[2 * n] = {0, 0, 0.2};
  for (int levels = 1; levels <= 3; ++levels) {
    const TriangleMesh a = refined(cup, levels), b = refined(lid, levels);
    const std::vector<Vec3d> ring(cup.positions.begin() + 2 * n, cup.positions.begin() + 3 * n);
    for (const Vec3d& p : splineRefined(ring, levels)) {
      const auto nearestIn = [&](const TriangleMesh& mesh) {
        return *std::min_element(mesh.positions.begin(), mesh.positions.end(),
                                 [&](Vec3d q, Vec3d r) { return length(q - p) < length(r - p); });
      };
      const Vec3d in_cup = nearestIn(a);
      EXPECT_LT(length(in_cup - p), 1e-6);
      EXPECT_EQ(in_cup, nearestIn(b));  // to the last bit
    }
  }
}

// The rule of fractional sharpness: levels before the last whole one are sharp, the next is the
// mean of the sharp and the smooth rule weighted by the rest, all further ones are smooth.
TEST(MotionCrease, FractionalSharpnessIsTheMeanOfSharpAndSmoothOnItsLevel) {
  for (const int whole : {0, 1, 2}) {
    const int levels = whole + 1;
    const auto at = [&](float s) { return refined(cylinder(9, 3, s), levels).positions; };
    const auto lower = at(static_cast<float>(whole)), upper = at(static_cast<float>(whole + 1));
    const auto sharp = at(kInfiniteSharpness);
    for (const float rest : {0.25f, 0.5f, 0.875f}) {
      const auto mean = at(static_cast<float>(whole) + rest);
      double moved = 0;
      for (std::size_t v = 0; v < mean.size(); ++v) {
        const Vec3d expected = (1.0 - rest) * lower[v] + double{rest} * upper[v];
        EXPECT_LT(length(mean[v] - expected), 5e-7);
        EXPECT_LT(length(upper[v] - sharp[v]), 5e-7);  // sharp on every level so far
        moved = std::max(moved, length(upper[v] - lower[v]));
      }
      EXPECT_GT(moved, 0.01);
    }
  }
}

TEST(MotionCrease, ACornerStaysWhereItIs) {
  TriangleMesh ball = octahedron(1);
  EXPECT_GT(distanceTo(refined(ball, 3), {0, 0, 1}), 0.1);
  ball.tags.vertices = {{4, kInfiniteSharpness}};
  EXPECT_EQ(distanceTo(refined(ball, 3), {0, 0, 1}), 0);
  ball.tags.vertices = {{4, 1}};
  EXPECT_EQ(distanceTo(refined(ball, 1), {0, 0, 1}), 0);
  EXPECT_GT(distanceTo(refined(ball, 3), {0, 0, 1}), 0.01);
}

TEST(MotionCrease, MirroredProbeFrameMirrorsThePositions) {
  const TestFolder folder;
  const TriangleMesh drum = cylinder(8, 3, kInfiniteSharpness);
  std::string text = objText(drum);
  for (const SharpEdge& e : drum.tags.edges)
    text += "t crease 2/1/0 " + std::to_string(e.v0) + " " + std::to_string(e.v1) + " 10\n";
  Scene scene = sceneOf(structureOf({folder.write("drum.obj", text)}));
  scene.motion.subdivision = 2;
  Scene mirrored = scene;
  mirrored.probe.pose.y_axis = {0, -1, 0};
  const MeshMotion motion(scene), turned(mirrored);
  SurfaceFrame frame, other;
  motion.frameAt(0, frame);
  turned.frameAt(0, other);
  const double volume = enclosedVolume(motion.surfaces()[0], frame.positions_m[0]);
  EXPECT_NEAR(enclosedVolume(turned.surfaces()[0], other.positions_m[0]) / volume, 1, 1e-6);
  TriangleMesh all;
  for (const Vec3f& p : other.positions_m[0]) all.positions.push_back(toDouble(p));
  for (const Vec3f& p : frame.positions_m[0])
    EXPECT_LT(distanceTo(all, toDouble(Vec3f{p.x, -p.y, p.z})), 2e-9);
}

// A hub with thousands of spokes: every refined vertex near it depends on all of its rim.
TEST(MotionCrease, MemoryThatOneVertexOfManyFacesWouldNeedIsRefused) {
  const TriangleMesh hub = cylinder(20000, 2, 0);
  const std::string error = errorOf([&] {
    Subdivision(hub.triangles, static_cast<std::uint32_t>(hub.positions.size()), {}, 2,
                {"scene.toml", 4, "motion.subdivision"});
  });
  EXPECT_EQ(error,
            "scene.toml:4: motion.subdivision: 2 levels need about 6404 million weights for this "
            "mesh, at most 400 million are accepted; use fewer levels or split the vertex at which "
            "20000 faces meet");
}

}  // namespace
}  // namespace echocine::motion_test
