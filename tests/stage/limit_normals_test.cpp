// Normals of the limit surface against shapes that have closed forms, and against facets of
// surfaces refined so far that they are the limit.

#include "motion/subdivision/limit_normals.h"

#include <random>

#include "tests/stage/crease_fixtures.h"

namespace echocine::motion_test {
namespace {

struct Normals {
  std::vector<Vec3f> values;
  std::vector<Triangle> corners;  // of the refined triangles

  Normals(const TriangleMesh& mesh, int levels) {
    const auto count = static_cast<std::uint32_t>(mesh.positions.size());
    const LimitNormals limit(mesh.triangles, count, mesh.tags, levels, {});
    values.resize(limit.normalCount());
    limit.apply(floats(mesh), values);
    corners = limit.corners();
    if (!corners.empty()) return;
    corners = levels > 0 ? Subdivision(mesh.triangles, count, mesh.tags, levels, {}).triangles()
                         : mesh.triangles;
  }
};

TEST(LimitNormals, OfAnOctahedronAreRadialAtItsCornersAndNearlySoElsewhere) {
  for (const int levels : {0, 1, 3}) {
    const TriangleMesh ball = octahedron(0.02, {0.01, 0.03, 0.09});
    const Normals normals(ball, levels);
    const TriangleMesh fine = levels > 0 ? refined(ball, levels) : ball;
    ASSERT_EQ(normals.values.size(), fine.positions.size());
    for (std::size_t v = 0; v < fine.positions.size(); ++v) {
      const Vec3d radial = normalised(fine.positions[v] - Vec3d{0.01, 0.03, 0.09});
      const Vec3d n = toDouble(normals.values[v]);
      EXPECT_NEAR(length(n), 1, 1e-6);
      EXPECT_GT(dot(n, radial), v < 6 ? 1 - 1e-6 : 0.99);
    }
  }
}

TEST(LimitNormals, OfAPlaneAreItsOwnExactlyAlsoAtItsBoundaryAndFarAway) {
  TriangleMesh sheet;
  std::mt19937 random(3);
  for (int j = 0; j < 7; ++j)
    for (int i = 0; i < 7; ++i)
      sheet.positions.push_back({i + 0.3 * static_cast<double>(random() % 100) / 100,
                                 j + 0.3 * static_cast<double>(random() % 100) / 100, 1234.567});
  for (std::uint32_t j = 0; j < 6; ++j)
    for (std::uint32_t i = 0; i < 6; ++i) {
      const std::uint32_t a = 7 * j + i, b = a + 1, c = a + 8, d = a + 7;
      sheet.triangles.push_back({a, b, c});
      sheet.triangles.push_back({a, c, d});
    }
  for (const int levels : {0, 2}) {
    int without = 0;
    for (const Vec3f& n : Normals(sheet, levels).values) {
      if (n == Vec3f{})
        ++without;
      else
        EXPECT_EQ(n, (Vec3f{0, 0, 1}));
    }
    // Two corners of the sheet have a single face; its neighbours' normals serve there.
    EXPECT_EQ(without, 2);
  }
}

// Every corner of a triangle of the cube has the normal of its side, on both sides of each edge.
TEST(LimitNormals, OnSharpEdgesEachFaceHasItsOwn) {
  for (const int levels : {0, 1, 3}) {
    const TriangleMesh cube = creasedCube();
    const TriangleMesh fine = levels > 0 ? refined(cube, levels) : cube;
    const Normals normals(cube, levels);
    ASSERT_EQ(normals.corners.size(), fine.triangles.size());
    for (std::size_t t = 0; t < fine.triangles.size(); ++t) {
      const Triangle& c = fine.triangles[t];
      const Vec3d side = normalised(cross(fine.positions[c[1]] - fine.positions[c[0]],
                                          fine.positions[c[2]] - fine.positions[c[0]]));
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_GT(dot(toDouble(normals.values[normals.corners[t][k]]), side), 1 - 1e-6);
    }
  }
}

TEST(LimitNormals, OfADrumPointAlongItOnTheCapsAndAcrossOnTheWall) {
  const TriangleMesh drum = cylinder(12, 5, kInfiniteSharpness);
  const TriangleMesh fine = refined(drum, 2);
  const Normals normals(drum, 2);
  int caps = 0, wall = 0;
  for (std::size_t t = 0; t < fine.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d p = fine.positions[fine.triangles[t][k]];
      const Vec3d n = toDouble(normals.values[normals.corners[t][k]]);
      const bool is_cap = std::abs(fine.positions[fine.triangles[t][0]].z) > 1 - 1e-6 &&
                          std::abs(fine.positions[fine.triangles[t][1]].z) > 1 - 1e-6 &&
                          std::abs(fine.positions[fine.triangles[t][2]].z) > 1 - 1e-6;
      (is_cap ? caps : wall) += 1;
      if (is_cap) {
        EXPECT_GT(n.z * (p.z > 0 ? 1 : -1), 1 - 1e-6);
      } else {
        EXPECT_LT(std::abs(n.z), 1e-3);  // the spline's wall is a cylinder to rounding
        EXPECT_GT(dot(n, normalised(Vec3d{p.x, p.y, 0})), 0.99);
      }
    }
  EXPECT_GT(caps, 100);
  EXPECT_GT(wall, 100);
}

// A bumpy ball with everything on it: extraordinary vertices, creases of whole, fractional and
// infinite sharpness, a dart and a corner.
TriangleMesh bumpyBall() {
  TriangleMesh ball = sphere(1, 1);
  std::mt19937 random(7);
  for (Vec3d& p : ball.positions) p = (0.9 + 0.2 * static_cast<double>(random() % 1000) / 1000) * p;
  const auto crease = [&](std::size_t t, std::size_t k, float sharpness) {
    const std::uint32_t a = ball.triangles[t][k], b = ball.triangles[t][(k + 1) % 3];
    ball.tags.edges.push_back({std::min(a, b), std::max(a, b), sharpness});
  };
  crease(0, 0, 1.5f);
  crease(6, 1, 2.25f);
  crease(13, 0, kInfiniteSharpness);
  crease(21, 2, 0.5f);
  return ball;
}

// A control vertex keeps its number on every level.
Vec3d facetMean(const TriangleMesh& mesh, std::uint32_t v) {
  Vec3d sum{};
  for (const Triangle& t : mesh.triangles)
    if (t[0] == v || t[1] == v || t[2] == v)
      sum = sum + cross(mesh.positions[t[1]] - mesh.positions[t[0]],
                        mesh.positions[t[2]] - mesh.positions[t[0]]);
  return normalised(sum);
}

TEST(LimitNormals, AreThoseThatTheFacetsTendTo) {
  const TriangleMesh ball = bumpyBall();
  const Normals normals(ball, 0);
  std::vector<bool> split(ball.positions.size(), false);
  for (std::size_t t = 0; t < ball.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (normals.corners[t][k] >= ball.positions.size()) split[ball.triangles[t][k]] = true;
  EXPECT_EQ(std::count(split.begin(), split.end(), true), 2);  // the ends of the sharp edge
  double worst_before = 1;
  for (const int levels : {1, 3, 5}) {  // further on, facets tilt by the rounding of their corners
    const TriangleMesh fine = refined(ball, levels);
    double worst = 0;
    for (std::uint32_t v = 0; v < ball.positions.size(); ++v)
      if (!split[v])
        worst = std::max(worst, length(facetMean(fine, v) - toDouble(normals.values[v])));
    EXPECT_LT(worst, worst_before / 2);
    worst_before = worst;
  }
  EXPECT_LT(worst_before, 1e-4);
}

TEST(LimitNormals, DoNotDependOnHowFarTheMeshIsRefined) {
  const TriangleMesh ball = bumpyBall();
  const Normals coarse(ball, 0);
  for (const int levels : {1, 3}) {
    const Normals fine(ball, levels);
    for (std::size_t v = 0; v < ball.positions.size(); ++v)
      EXPECT_LT(length(coarse.values[v] - fine.values[v]), 2e-5f) << v << " at " << levels;
  }
}

TEST(LimitNormals, OfASceneLookOutwardAlsoInAMirroredProbeFrame) {
  const TestFolder folder;
  for (const double y : {1.0, -1.0})
    for (const int levels : {0, 2})
      for (const auto& radii : {std::vector<double>{2}, {2, 1.5, 1.8}}) {
        Scene scene = beatingBall(folder, radii, 1);
        scene.accuracy.normals = echocine::Normals::smooth;
        scene.motion.subdivision = levels;
        scene.probe.pose.y_axis = {0, y, 0};
        const MeshMotion motion(scene);
        SurfaceFrame frame;
        motion.frameAt(0.2, frame);
        ASSERT_EQ(frame.normals.size(), 1u);
        ASSERT_EQ(frame.normals[0].size(), frame.positions_m[0].size());
        for (std::size_t v = 0; v < frame.normals[0].size(); ++v)
          EXPECT_GT(dot(frame.normals[0][v], normalised(frame.positions_m[0][v])), 0.99f);
      }
}

TEST(LimitNormals, WhatTheirSetUpCannotBearIsRefused) {
  const auto says = [](const TriangleMesh& mesh) {
    return errorOf([&] {
      LimitNormals(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()), mesh.tags, 1,
                   {"scene.toml", 9, "accuracy.normals"});
    });
  };
  EXPECT_EQ(says(cylinder(130, 2, 0)),
            "scene.toml:9: accuracy.normals: smooth normals accept up to 128 faces at a vertex, "
            "this mesh has one with 130; split it or use normals = \"facet\"");
  EXPECT_EQ(says(cylinder(100, 2, 9.5f)),
            "scene.toml:9: accuracy.normals: smooth normals need 10 levels to follow this mesh's "
            "200 creases that are not infinitely sharp; make them 10 or softer");
}

TEST(LimitNormals, AreNotMadeForFacets) {
  const TestFolder folder;
  const Scene scene = beatingBall(folder, {2, 1.5}, 1);
  const MeshMotion motion(scene);
  SurfaceFrame frame;
  motion.frameAt(0.2, frame);
  EXPECT_TRUE(frame.normals.empty());
  EXPECT_TRUE(motion.surfaces()[0].normal_corners.empty());
}

}  // namespace
}  // namespace echocine::motion_test
