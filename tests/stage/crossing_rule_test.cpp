// The rule that decides whether a ray crosses a triangle: no crossing lost or doubled on shared
// vertices and edges, without tolerance.

#include "geometry/crossing_rule.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/surfaces.h"

namespace echocine {
namespace {

using namespace support;

// Crossings of a closed mesh by the rule alone, nearest first.
std::vector<Crossing> crossed(const Surfaces& mesh, const Ray& ray) {
  std::vector<Crossing> all = mesh.crossEvery(ray, 0);
  std::sort(all.begin(), all.end(),
            [](const Crossing& a, const Crossing& b) { return a.distance_m < b.distance_m; });
  return all;
}

// Entries less exits: 0 for a ray from outside, -1 from inside.
int balance(const std::vector<Crossing>& all) {
  int sum = 0;
  for (const Crossing& c : all) sum += c.entering ? 1 : -1;
  return sum;
}

std::vector<Mesh> closedMeshes() {
  return {octahedron(), icosphere(1, 1), octasphere(3, 1), uvSphere(8, 12, 1),
          box({-1, -0.5, -0.25}, {1, 0.5, 0.25})};
}

// Points of the mesh that rays should not slip past: vertices, edge middles, face centres.
std::vector<Vec3d> targets(const Mesh& mesh) {
  std::vector<Vec3d> all = mesh.points;
  for (const auto& [a, b, c] : mesh.triangles) {
    all.push_back(0.5 * (mesh.points[a] + mesh.points[b]));
    all.push_back((1.0 / 3) * (mesh.points[a] + mesh.points[b] + mesh.points[c]));
  }
  return all;
}

TEST(CrossingRule, RaysFromInsideThroughVerticesEdgesAndFacesLeaveOnce) {
  for (const Mesh& mesh : closedMeshes()) {
    const Surfaces surfaces({mesh});
    for (const Vec3d target : targets(mesh))
      for (const Vec3d start : {Vec3d{0, 0, 0}, Vec3d{0.125, 0, 0.0625}, Vec3d{0.01, 0.02, 0.03}})
        EXPECT_EQ(balance(crossed(surfaces, rayFromTo(start, target))), -1);
  }
}

TEST(CrossingRule, RaysFromOutsideThroughVerticesAndEdgesEnterAsOftenAsTheyLeave) {
  for (const Mesh& mesh : closedMeshes()) {
    const Surfaces surfaces({mesh});
    for (const Vec3d target : targets(mesh))
      for (const Vec3d start : {Vec3d{0, 0, -4}, Vec3d{3, 0, 0}, Vec3d{2, 2, 0}, Vec3d{1, -5, 0.3}})
        EXPECT_EQ(balance(crossed(surfaces, rayFromTo(start, target))), 0);
  }
}

// A convex surface is crossed twice or not at all, also when its edges lie in the imaging plane.
TEST(CrossingRule, AConvexMeshSymmetricAboutTheImagingPlaneIsCrossedTwiceOrNotAtAll) {
  const Surfaces surfaces({octasphere(4, 1)});
  for (int i = -1000; i <= 1000; ++i) {
    const double angle = i * 1e-3;
    const std::vector<Crossing> all =
        crossed(surfaces, {{0, 0, -2}, {std::sin(angle), 0, std::cos(angle)}});
    const double miss = 2 * std::abs(std::sin(angle));  // of the centre
    EXPECT_EQ(all.size() % 2, 0u);
    EXPECT_LE(all.size(), 2u);
    if (miss < 0.995) {
      EXPECT_EQ(all.size(), 2u);
    }
    if (miss > 1) {
      EXPECT_EQ(all.size(), 0u);
    }
  }
}

TEST(CrossingRule, RandomRaysMeetASphereWhereItIs) {
  const Surfaces surfaces({icosphere(5, 1)});
  RandomVectors random(11);
  double worst = 0;
  for (int i = 0; i < 300; ++i) {
    const Ray ray{3.0 * random.direction(), {}};
    const Ray aimed = rayFromTo(ray.origin, 0.9 * random.direction());
    const double b = dot(aimed.origin, aimed.direction);
    const double h2 = 1 - dot(aimed.origin, aimed.origin) + b * b;
    if (h2 < 0.1) continue;
    const std::vector<Crossing> all = crossed(surfaces, aimed);
    ASSERT_EQ(all.size(), 2u);
    EXPECT_TRUE(all[0].entering && !all[1].entering);
    worst = std::max({worst, std::abs(all[0].distance_m - (-b - std::sqrt(h2))),
                      std::abs(all[1].distance_m - (-b + std::sqrt(h2)))});
  }
  EXPECT_LT(worst, 5e-4 / std::sqrt(0.1));  // the facets' sag over the cosine
}

TEST(CrossingRule, NormalsAreUnitAndLookOut) {
  const Surfaces surfaces({icosphere(3, 1)});
  RandomVectors random(5);
  for (int i = 0; i < 300; ++i) {
    const Ray ray = rayFromTo(2.0 * random.direction(), 0.5 * random.direction());
    for (const Crossing& c : crossed(surfaces, ray)) {
      EXPECT_NEAR(length(c.normal), 1, 1e-12);
      EXPECT_GT(dot(c.normal, ray.origin + c.distance_m * ray.direction), 0.98);
      EXPECT_EQ(c.entering, dot(c.normal, ray.direction) < 0);
    }
  }
}

TEST(CrossingRule, ARayInThePlaneOfAFacetIsCountedByItsNeighbours) {
  const Surfaces surfaces({box({-1, -1, -1}, {1, 1, 1})});
  for (const double y : {-1.0, 1.0})
    for (const double x : {-1.0, -0.5, 0.0, 1.0}) {
      const std::vector<Crossing> all = crossed(surfaces, {{x, y, -3}, {0, 0, 1}});
      EXPECT_EQ(balance(all), 0) << x << ' ' << y;
      EXPECT_LE(all.size(), 2u);
    }
  // Grazing along an edge of the box within the plane of two of its faces.
  EXPECT_EQ(balance(crossed(surfaces, {{-3, 1, 1}, {1, 0, 0}})), 0);
}

// A square face whose one edge is split: the gap is closed by a triangle without area.
Mesh boxWithFlatTriangle() {
  Mesh m = box({-1, -1, -1}, {1, 1, 1});
  m.points.push_back({0, -1, -1});  // in the middle of edge 0-1
  const std::uint32_t middle = 8;
  std::erase(m.triangles, Triangle{0, 2, 1});
  m.triangles.insert(m.triangles.end(), {{0, 2, middle}, {middle, 2, 1}, {0, middle, 1}});
  return m;
}

TEST(CrossingRule, ATriangleWithoutAreaNeitherLeaksNorCounts) {
  const Surfaces surfaces({boxWithFlatTriangle()});
  for (int i = -20; i <= 20; ++i)
    for (const double y : {-1.0, -0.75, 0.0}) {
      const double x = i * 0.05;
      EXPECT_EQ(balance(crossed(surfaces, rayFromTo({0, 0, 0}, {x, y, -1}))), -1) << x << ' ' << y;
      EXPECT_EQ(balance(crossed(surfaces, {{x, y, -3}, {0, 0, 1}})), 0) << x << ' ' << y;
      EXPECT_EQ(balance(crossed(surfaces, rayFromTo({x, -3, -3}, {x, -1, -1}))), 0) << x;
    }
}

TEST(CrossingRule, NormalsOfTrianglesWithoutAreaAreUnitToo) {
  const RayPlanes ray({{0, 0.3, 0}, {0, 0, 1}});
  const auto c = crossTriangle(ray, {-1, 0, 1}, {1, 0, 1}, {0, 0.6f, 1}, SurfaceId{0}, 0);
  ASSERT_TRUE(c);
  const RayPlanes tilted(rayFromTo({0, -2, -2}, {0.25, -1, -1}));
  for (const Vec3f third : {Vec3f{0, -1, -1}, Vec3f{0.25f, -1, -1}, Vec3f{1, -1, -1}})
    if (const auto flat =
            crossTriangle(tilted, {-1, -1, -1}, {1, -1, -1}, third, SurfaceId{0}, 0)) {
      EXPECT_NEAR(length(flat->normal), 1, 1e-12);
    }
}

// Needles a millionth as wide as long, sharing their long edges.
TEST(CrossingRule, SliversShareTheirEdgesExactly) {
  Mesh fan = uvSphere(4, 4096, 1);
  for (Vec3d& p : fan.points) p.x *= 1e-3;
  const Surfaces surfaces({fan});
  RandomVectors random(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3d target = fan.points[static_cast<std::size_t>(
        random.number(0, 1) * static_cast<double>(fan.points.size()))];
    EXPECT_EQ(balance(crossed(surfaces, rayFromTo({0, 0, 0}, target))), -1);
    EXPECT_EQ(balance(crossed(surfaces, rayFromTo({2, 1, -3}, target))), 0);
  }
}

TEST(CrossingRule, NothingBehindOrAtTheStartIsCrossed) {
  const Surfaces surfaces({box({-1, -1, 1}, {1, 1, 2})});
  EXPECT_TRUE(crossed(surfaces, {{0.3, 0.2, 2}, {0, 0, 1}}).empty());
  EXPECT_TRUE(crossed(surfaces, {{0.3, 0.2, 3}, {0, 0, 1}}).empty());
  EXPECT_EQ(crossed(surfaces, {{0.3, 0.2, 1}, {0, 0, 1}}).size(), 1u);
}

// What four lanes say of one triangle is what the rule for one says, to the last bit.
void expectLanesAgree(const RayPlanes& ray, const std::array<std::array<Vec3f, 3>, 4>& four) {
  std::array<Vec3<Floats4>, 3> corners;
  for (std::size_t lane = 0; lane < kDoubleLanes; ++lane)
    for (std::size_t c = 0; c < 3; ++c) {
      corners[c].x[lane] = four[lane][c].x;
      corners[c].y[lane] = four[lane][c].y;
      corners[c].z[lane] = four[lane][c].z;
    }
  const LaneCrossings met = crossTriangles(ray, corners);
  for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
    const auto& [p0, p1, p2] = four[lane];
    const auto one = crossTriangle(ray, p0, p1, p2, SurfaceId{0}, 0);
    ASSERT_EQ(met.crossed[lane] != 0, one.has_value());
    if (!one) continue;
    EXPECT_EQ(met.entering[lane] != 0, one->entering);
    EXPECT_EQ(met.distance_m[lane], one->distance_m);
    const Vec3d normal{met.normal.x[lane], met.normal.y[lane], met.normal.z[lane]};
    if (length(areaNormal(toDouble(p0), toDouble(p1), toDouble(p2))) > 0) {
      EXPECT_TRUE(normal == one->normal);
    } else {
      EXPECT_FALSE(isFinite(normal));
    }
  }
}

// Corners on a coarse grid lie often on each other, on the ray and in its planes.
TEST(CrossingRule, FourTrianglesAtOnceAreFourTriangles) {
  RandomVectors random(21);
  for (const double cells : {1.0, 2.0, 1e6}) {
    const auto number = [&] { return std::round(random.number(-1, 1) * cells) / cells; };
    const auto corner = [&] { return toFloat(Vec3d{number(), number(), number()}); };
    for (int i = 0; i < 5000; ++i) {
      std::array<std::array<Vec3f, 3>, 4> four;
      for (auto& triangle : four) triangle = {corner(), corner(), corner()};
      expectLanesAgree(RayPlanes({{number(), number(), -1}, {0, 0, 1}}), four);
      expectLanesAgree(RayPlanes({{number(), number(), number()}, random.direction()}), four);
    }
  }
}

}  // namespace
}  // namespace echocine
