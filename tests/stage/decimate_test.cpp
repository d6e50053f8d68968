// Coarser meshes for display: closed ones stay closed and as large, sheets keep their outline,
// and what is no manifold loses nothing.

#include "motion/mesh/decimate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>

#include "motion/mesh/surface_measure.h"
#include "motion/subdivision/subdivision.h"
#include "support/meshes.h"

namespace echocine {
namespace {

using support::Mesh;

std::vector<Vec3f> single(const std::vector<Vec3d>& points) {
  std::vector<Vec3f> out;
  for (const Vec3d p : points) out.push_back(toFloat(p));
  return out;
}

std::vector<Vec3f> chosen(const DecimatedMesh& mesh, const std::vector<Vec3f>& all) {
  std::vector<Vec3f> out;
  for (const std::uint32_t v : mesh.vertices) out.push_back(all[v]);
  return out;
}

// How often each directed edge lacks its opposite.
std::size_t openEdges(const std::vector<Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) ++edges[{t[i], t[(i + 1) % 3]}];
  std::size_t open = 0;
  for (const auto& [edge, count] : edges)
    if (const auto back = edges.find({edge.second, edge.first});
        back == edges.end() || back->second != count)
      ++open;
  return open;
}

double area(const std::vector<Triangle>& triangles, const std::vector<Vec3f>& positions) {
  double sum = 0;
  for (const Triangle& t : triangles) sum += 0.5 * length(doubleArea(t, positions));
  return sum;
}

TEST(Decimate, ABallStaysClosedAndKeepsItsVolume) {
  const Mesh ball = support::icosphere(5, 1);
  const std::vector<Vec3f> all = single(ball.points);
  for (const std::size_t most : {4000u, 1000u, 300u}) {
    const DecimatedMesh coarse = decimated(ball.triangles, all, most);
    EXPECT_LE(coarse.triangles.size(), most);
    EXPECT_GE(coarse.triangles.size(), most - 2);  // a collapse takes two
    EXPECT_EQ(openEdges(coarse.triangles), 0u);
    EXPECT_TRUE(std::is_sorted(coarse.vertices.begin(), coarse.vertices.end()));
    // Vertices lie on the sphere: the best polyhedron of F such faces lacks about 4 pi / (sqrt(3)
    // F) of its volume, and twice that is accepted.
    const double sphere = 4 * std::numbers::pi / 3;
    const double lost = 1 - enclosedVolume(coarse.triangles, chosen(coarse, all)) / sphere;
    EXPECT_GT(lost, 0);
    EXPECT_LT(lost, 2 * 4 * std::numbers::pi / (std::sqrt(3.0) * static_cast<double>(most)))
        << most;
  }
}

TEST(Decimate, WhatIsCoarseAlreadyStaysAndUnusedVerticesGo) {
  const Mesh ball = support::icosphere(1, 1);
  std::vector<Vec3f> all = single(ball.points);
  all.insert(all.begin(), Vec3f{9, 9, 9});
  std::vector<Triangle> triangles = ball.triangles;
  for (Triangle& t : triangles)
    for (std::uint32_t& corner : t) ++corner;
  const DecimatedMesh same = decimated(triangles, all, triangles.size());
  EXPECT_EQ(same.triangles, ball.triangles);
  EXPECT_EQ(same.vertices.size(), ball.points.size());
  EXPECT_EQ(same.vertices.front(), 1u);
}

TEST(Decimate, ASheetKeepsItsOutline) {
  const Mesh flat = support::sheet(40, 2, 0);
  const std::vector<Vec3f> all = single(flat.points);
  const DecimatedMesh coarse = decimated(flat.triangles, all, 400);
  EXPECT_LT(coarse.triangles.size(), flat.triangles.size() / 4);
  EXPECT_NEAR(area(coarse.triangles, chosen(coarse, all)), area(flat.triangles, all), 1e-5);
  EXPECT_EQ(openEdges(coarse.triangles), openEdges(flat.triangles));
}

// Three sheets at one edge, which no half-edge mesh holds.
TEST(Decimate, AThirdFaceAtAnEdgeIsNotLost) {
  Mesh fan = support::sheet(12, 1, 0);
  const auto half = static_cast<std::uint32_t>(fan.points.size());
  Mesh upright = support::sheet(12, 1, 0);
  for (Vec3d& p : upright.points) p = {p.x, 0, std::abs(p.y) + 1e-9};
  for (const Vec3d p : upright.points) fan.points.push_back(p);
  for (Triangle t : upright.triangles) {
    for (std::uint32_t& corner : t) corner += half;
    fan.triangles.push_back(t);
  }
  // And the very same faces once more, over the first ones.
  fan.triangles.insert(fan.triangles.end(), upright.triangles.begin(), upright.triangles.end());
  const std::vector<Vec3f> all = single(fan.points);
  const DecimatedMesh coarse = decimated(fan.triangles, all, fan.triangles.size() - 1);
  EXPECT_NEAR(area(coarse.triangles, chosen(coarse, all)), area(fan.triangles, all),
              0.02 * area(fan.triangles, all));
}

// Decimated control meshes lie on the subdivided surface by this.
TEST(Decimate, SubdivisionPutsControlVerticesFirst) {
  const Mesh ball = support::icosphere(1, 1);
  const std::vector<Vec3f> control = single(ball.points);
  for (int levels = 1; levels <= 3; ++levels) {
    const Subdivision subdivision(ball.triangles, static_cast<std::uint32_t>(control.size()), {},
                                  levels, {});
    std::vector<Vec3f> refined(subdivision.vertexCount());
    subdivision.apply(control, refined);
    for (std::size_t i = 0; i < control.size(); ++i)
      for (std::size_t j = 0; j < control.size(); ++j)
        if (j != i) {
          EXPECT_LT(length(toDouble(refined[i]) - toDouble(control[i])),
                    length(toDouble(refined[i]) - toDouble(control[j])));
        }
  }
}

}  // namespace
}  // namespace echocine
