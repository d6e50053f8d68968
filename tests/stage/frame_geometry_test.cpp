// One frame's surfaces: the hierarchy must find what the rule finds, and the states along a ray
// must hold together wherever it starts.

#include "geometry/frame_geometry.h"

#include <gtest/gtest.h>

#include "support/surfaces.h"

namespace echocine {
namespace {

using namespace support;

// Along a ray every surface's entries and exits alternate and end outside.
void expectConsistent(const RayCrossings& met, std::size_t surfaces, const Ray& ray) {
  InsideSet inside = met.inside;
  double last = 0;
  for (const Crossing& c : met.crossings) {
    EXPECT_GE(c.distance_m, last);
    last = c.distance_m;
    EXPECT_NE(inside[index(c.surface)], c.entering)
        << "from " << ray.origin.x << ' ' << ray.origin.y << ' ' << ray.origin.z;
    inside[index(c.surface)] = c.entering;
  }
  for (std::size_t s = 0; s < surfaces; ++s) EXPECT_FALSE(inside[s]);
}

// Changes of the first surface's state; crossings at one place, as where a vertex is folded by
// rounding, are one.
int passages(const RayCrossings& met) {
  int count = 0;
  bool inside = met.inside[0];
  for (std::size_t i = 0; i < met.crossings.size(); ++i) {
    const bool last_here = i + 1 == met.crossings.size() ||
                           met.crossings[i + 1].distance_m - met.crossings[i].distance_m > 1e-9;
    if (!last_here || met.crossings[i].entering == inside) continue;
    inside = met.crossings[i].entering;
    ++count;
  }
  return count;
}

void expectTwoCrossings(const Surfaces& surfaces, const Ray& ray) {
  const RayCrossings met = surfaces.cross(ray);
  EXPECT_EQ(passages(met), 2) << ray.direction.x << ' ' << ray.direction.y << ' '
                              << ray.direction.z;
  expectConsistent(met, 1, ray);
}

// The oracle is the rule itself, asked for every triangle: the hierarchy may only be faster.
TEST(FrameGeometry, FindsForRandomRaysWhatTheRuleFindsForEveryTriangle) {
  const Surfaces surfaces({icosphere(4, 0.04)});
  RandomVectors random(1);
  for (int i = 0; i < 3000; ++i) {
    const Ray ray = rayFromTo(0.1 * random.direction(), 0.042 * random.direction());
    const RayCrossings met = surfaces.cross(ray);
    expectConsistent(met, 1, ray);
    std::vector<Crossing> all = surfaces.crossEvery(ray, 0);
    std::sort(all.begin(), all.end(), [](auto& a, auto& b) { return a.distance_m < b.distance_m; });
    ASSERT_EQ(met.crossings.size(), all.size());
    for (std::size_t k = 0; k < all.size(); ++k) {
      EXPECT_EQ(met.crossings[k].triangle, all[k].triangle);
      EXPECT_EQ(met.crossings[k].distance_m, all[k].distance_m);
    }
  }
}

TEST(FrameGeometry, RaysFromInsideASphereLeaveItOnce) {
  const Surfaces surfaces({octasphere(4, 0.04)});
  RandomVectors random(2);
  for (int i = 0; i < 5000; ++i) {
    const Ray ray{0.035 * random.number(0, 1) * random.direction(), random.direction()};
    const RayCrossings met = surfaces.cross(ray);
    ASSERT_EQ(met.crossings.size(), 1u);
    EXPECT_FALSE(met.crossings[0].entering);
    EXPECT_TRUE(met.inside[0]);
  }
}

// Where antipodal points are hit at once, a crossing lost on both sides would keep the balance.
// Six triangles share a vertex; counting it six times or not at all are the usual failures.
TEST(FrameGeometry, RaysThroughTheCentreAimedExactlyAtVerticesCrossTwice) {
  for (const Mesh& mesh : {icosphere(3, 0.04), octasphere(4, 0.04), uvSphere(24, 32, 0.04)}) {
    const Surfaces surfaces({mesh});
    for (const Vec3d p : mesh.points) expectTwoCrossings(surfaces, rayFromTo(2.5 * p, {0, 0, 0}));
  }
}

TEST(FrameGeometry, RaysThroughTheCentreAimedExactlyAtEdgeMiddlesCrossTwice) {
  for (const Mesh& mesh : {icosphere(3, 0.04), octasphere(4, 0.04), uvSphere(24, 32, 0.04)}) {
    const Surfaces surfaces({mesh});
    for (const auto& [a, b, c] : mesh.triangles)
      expectTwoCrossings(surfaces, rayFromTo(1.3 * (mesh.points[a] + mesh.points[b]), {0, 0, 0}));
  }
}

TEST(FrameGeometry, RaysFromTheProbeAimedExactlyAtVerticesMissNothing) {
  const Vec3d centre{0.0123, 0, 0.0712};
  for (const Mesh& ball : {icosphere(3, 0.04), octasphere(4, 0.04), uvSphere(24, 32, 0.04)}) {
    const Mesh mesh = ball.moved(centre);
    const Surfaces surfaces({mesh});
    for (const Vec3d p : mesh.points) {
      const Ray ray = rayFromTo({0, 0, 0}, toDouble(toFloat(p)));
      const RayCrossings met = surfaces.cross(ray);
      expectConsistent(met, 1, ray);
      const Vec3d outward = p - centre;
      if (std::abs(dot(outward, ray.direction)) > 0.01) {
        EXPECT_EQ(passages(met), 2);
      }
    }
  }
}

TEST(FrameGeometry, TellsInsideFromOutside) {
  const Surfaces surfaces({icosphere(4, 0.04), icosphere(3, 0.02).moved({0.01, 0, 0})});
  RandomVectors random(4);
  for (int i = 0; i < 3000; ++i) {
    const Vec3d p = 0.05 * random.number(0, 1) * random.direction();
    const InsideSet inside = surfaces.geometry().insideAt(p);
    const double outer = length(p), inner = length(p - Vec3d{0.01, 0, 0});
    if (std::abs(outer - 0.04) > 2e-4) {
      EXPECT_EQ(inside[0], outer < 0.04);
    }
    if (std::abs(inner - 0.02) > 3e-4) {
      EXPECT_EQ(inside[1], inner < 0.02);
    }
  }
}

// On a surface inside and outside are both true; that states and crossings agree is what counts.
TEST(FrameGeometry, AProbeExactlyOnASurfaceHasOneOfTheTwoConsistentStates) {
  for (const Mesh& mesh :
       {octasphere(3, 0.04), icosphere(3, 0.04), box({-0.03, -0.03, -0.03}, {0.03, 0.03, 0.03})}) {
    const Surfaces surfaces({mesh});
    RandomVectors random(6);
    for (const Vec3d p : mesh.points) {
      const Vec3d on = toDouble(toFloat(p));
      for (int i = 0; i < 4; ++i) {
        const Ray ray{on, random.direction()};
        const RayCrossings met = surfaces.cross(ray);
        expectConsistent(met, 1, ray);
        const double way = dot(ray.direction, normalised(p));
        if (way > 0.85) {
          EXPECT_LE(met.crossings.size(), 1u);
        }
        if (way < -0.85) {
          EXPECT_GE(met.crossings.size(), 1u);
        }
      }
    }
  }
}

TEST(FrameGeometry, CoincidentStructuresAreBothCrossedAtTheSameDistance) {
  const Mesh mesh = octasphere(4, 0.04).moved({0, 0, 0.07});
  const Surfaces surfaces({mesh, mesh});
  for (int i = -60; i <= 60; ++i) {
    const Ray ray{{0, 0, 0}, {std::sin(i * 0.01), 0, std::cos(i * 0.01)}};
    const RayCrossings met = surfaces.cross(ray);
    expectConsistent(met, 2, ray);
    ASSERT_EQ(met.crossings.size() % 4, 0u);
    for (std::size_t k = 0; k < met.crossings.size(); k += 2) {
      EXPECT_EQ(met.crossings[k].distance_m, met.crossings[k + 1].distance_m);
      EXPECT_LT(met.crossings[k].surface, met.crossings[k + 1].surface);
    }
  }
}

TEST(FrameGeometry, DuplicateFacesWithinAMeshChangeTheStateOnce) {
  Mesh twice = octasphere(3, 0.04);
  const std::vector<Triangle> copy = twice.triangles;
  twice.triangles.insert(twice.triangles.end(), copy.begin(), copy.end());
  const Surfaces surfaces({twice});
  RandomVectors random(8);
  for (int i = 0; i < 500; ++i)
    expectTwoCrossings(surfaces, rayFromTo(0.1 * random.direction(), 0.03 * random.direction()));
}

TEST(FrameGeometry, FollowsVerticesThatMove) {
  Surfaces surfaces({icosphere(4, 0.03)});
  for (const double shift : {0.0, 0.01, -0.02, 0.5}) {
    for (const double size : {0.02, 0.05}) {
      surfaces.move({icosphere(4, size).moved({0, 0, shift})});
      const RayCrossings met = surfaces.cross({{1e-4, 2e-4, -1}, {0, 0, 1}});
      ASSERT_EQ(met.crossings.size(), 2u);
      EXPECT_NEAR(met.crossings[0].distance_m, 1 + shift - size, 1e-4);
      EXPECT_NEAR(met.crossings[1].distance_m, 1 + shift + size, 1e-4);
      EXPECT_TRUE(surfaces.geometry().insideAt({0, 0, shift})[0]);
      EXPECT_FALSE(surfaces.geometry().insideAt({0, 0, shift + 1.01 * size})[0]);
    }
  }
}

// A cavity that empties: its triangles have no area for a while, and must not be lost.
TEST(FrameGeometry, SurfacesThatShrinkToAPointAreNotMetAndComeBack) {
  const auto ball = [](double x) { return icosphere(2, 0.02).moved({x, 0, 0.08}); };
  const auto point = [&](double x) {
    Mesh mesh = ball(x);
    for (Vec3d& p : mesh.points) p = {x, 0, 0.08};
    return mesh;
  };
  const auto apex = [&](double x) {  // half of its triangles are one point
    Mesh mesh = ball(x);
    for (Vec3d& p : mesh.points)
      if (p.z < 0.08) p = {x, 0, 0.08};
    return mesh;
  };
  for (const bool from_points : {false, true}) {
    Surfaces surfaces({from_points ? point(0) : ball(0), from_points ? point(0.05) : ball(0.05)});
    for (int round = 0; round < 2; ++round) {
      surfaces.move({point(0), point(0)});
      EXPECT_TRUE(surfaces.cross({{1e-3, 2e-3, 0}, {0, 0, 1}}).crossings.empty());
      surfaces.move({apex(0), apex(0.05)});
      EXPECT_EQ(surfaces.cross({{1e-3, 2e-3, 0}, {0, 0, 1}}).crossings.size(), 2u);
      surfaces.move({ball(0), point(0.05)});
      EXPECT_EQ(surfaces.cross({{1e-3, 2e-3, 0}, {0, 0, 1}}).crossings.size(), 2u);
    }
  }
}

TEST(FrameGeometry, WithoutSurfacesNothingIsMet) {
  const Surfaces surfaces(std::vector<Mesh>{});
  EXPECT_TRUE(surfaces.cross({{0, 0, 0}, {0, 0, 1}}).crossings.empty());
}

// On a vertex a sheet may be met by several of its triangles at one distance; never by none.
TEST(FrameGeometry, AnOpenSheetIsNotMissedThroughItsInnerVerticesAndEdges) {
  const Surfaces surfaces({}, {sheet(16, 0.04, 0.07)});
  for (int j = 1; j < 32; ++j)
    for (int i = 1; i < 32; ++i) {
      const Vec3d target =
          toDouble(toFloat(Vec3d{0.04 * (i / 16.0 - 1), 0.04 * (j / 16.0 - 1), 0.07}));
      for (const Vec3d start : {Vec3d{0, 0, 0}, Vec3d{0.013, 0.002, -0.01}}) {
        const std::vector<Crossing> met = surfaces.cross(rayFromTo(start, target)).crossings;
        EXPECT_GE(met.size(), 1u) << i << ' ' << j;
        for (const Crossing& c : met) EXPECT_NEAR(c.distance_m, length(target - start), 1e-9);
      }
    }
}

// To the last bit, so that how rays are bundled is no matter of the picture.
TEST(FrameGeometry, APacketOfSixteenRaysIsSixteenSingleRays) {
  const Surfaces surfaces(
      {icosphere(4, 0.04).moved({0, 0, 0.07}), icosphere(2, 0.02).moved({0, 0, 0.06})});
  std::vector<RayQuery> queries;
  for (int i = 0; i < 16; ++i) {
    const double angle = -0.7 + 0.093 * i;
    queries.push_back({{{0, 0, 0}, {std::sin(angle), 0, std::cos(angle)}}, {}, {}});
  }
  std::vector<RayCrossings> met(16);
  surfaces.geometry().crossings(queries, met);
  for (std::size_t i = 0; i < 16; ++i) {
    const RayCrossings single = surfaces.cross(queries[i].ray);
    ASSERT_EQ(met[i].crossings.size(), single.crossings.size());
    for (std::size_t k = 0; k < single.crossings.size(); ++k)
      EXPECT_EQ(met[i].crossings[k].distance_m, single.crossings[k].distance_m);
  }
}

}  // namespace
}  // namespace echocine
