// Directions through a wall of coarse triangles, from which its fibres take theirs.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "core/hash_random.h"
#include "speckle/nearest_on_surface.h"
#include "speckle/tissue_strength.h"
#include "support/meshes.h"

namespace echocine {
namespace {

using namespace support;

constexpr double kInner_m = 0.025, kOuter_m = 0.034;

struct CoarseBall {
  std::vector<Triangle> triangles;
  std::vector<Vec3f> points_m;
  CoarseBall(int level, double radius_m) {
    const Mesh mesh = icosphere(level, radius_m);
    triangles = mesh.triangles;
    for (const Vec3d p : mesh.points) points_m.push_back(toFloat(p));
  }
};

// Places in the wall, uniform over directions and thickness.
Vec3d placeInWall(int i) {
  const auto drawn = [&](std::uint64_t axis) { return uniformFromHash(hashOf(i, axis, 77)); };
  const double z = 2 * drawn(0) - 1, phi = 2 * std::numbers::pi * drawn(1),
               s = std::sqrt(1 - z * z);
  const double r = kInner_m + (0.1 + 0.8 * drawn(2)) * (kOuter_m - kInner_m);
  return {r * s * std::cos(phi), r * s * std::sin(phi), r * z};
}

// RMS over places of the angle between the direction through the wall and the radius, degrees, and
// of the error in dB of the fibres' factor at 10 dB of anisotropy.
struct WallError {
  double degrees = 0, db = 0;
};
template <typename Nearest>
WallError errorOf(const Nearest& inner, const Nearest& outer) {
  WallError sum;
  constexpr int kPlaces = 4000;
  for (int i = 0; i < kPlaces; ++i) {
    const Vec3d place = placeInWall(i), radial = normalised(place);
    const Vec3d in = inner(toFloat(place)), out = outer(toFloat(place));
    const Vec3d through = normalised(out - in);
    sum.degrees += std::pow(std::acos(std::min(dot(through, radial), 1.0)), 2) / kPlaces;
    const double depth = length(place - in) / (length(place - in) + length(place - out)),
                 exact = (length(place) - kInner_m) / (kOuter_m - kInner_m);
    const Vec3d axis{0, 0, 1}, beam = normalised(Vec3d{1, 0, 2});
    const double ratio = fibreFactor(fibreAt(through, axis, depth, 1), beam, 10) /
                         fibreFactor(fibreAt(radial, axis, exact, 1), beam, 10);
    sum.db += std::pow(10 * std::log10(ratio), 2) / kPlaces;
  }
  return {std::sqrt(sum.degrees) * 180 / std::numbers::pi, std::sqrt(sum.db)};
}

// Edges of 9 mm about a wall of 9 mm, and half of that.
TEST(FibreDirection, OfACoarseWallIsThatThroughItsTriangles) {
  for (const int level : {2, 3}) {
    const CoarseBall a(level, kInner_m), b(level, kOuter_m);
    const NearestOnSurface inner(a.triangles, a.points_m), outer(b.triangles, b.points_m);
    const auto on = [](const NearestOnSurface& s) { return [&s](Vec3f p) { return s.to(p); }; };
    const NearestVertex inner_vertex(a.points_m), outer_vertex(b.points_m);
    const auto vertexOf = [](const NearestVertex& s) {
      return [&s](Vec3f p) { return toDouble(s.to(p)); };
    };
    const std::function<Vec3d(Vec3f)> in = on(inner), out = on(outer),
                                      in_vertex = vertexOf(inner_vertex),
                                      out_vertex = vertexOf(outer_vertex);
    const WallError by_surface = errorOf(in, out), by_vertex = errorOf(in_vertex, out_vertex);
    EXPECT_LT(by_surface.db, 0.7 * by_vertex.db) << level;
    EXPECT_LT(by_surface.db, level == 2 ? 0.7 : 0.2) << level;
    EXPECT_LT(by_surface.degrees, level == 2 ? 5 : 2.5) << level;
  }
}

// Against a search through all triangles, by places on them 100 to an edge.
TEST(FibreDirection, TheNearestPlaceIsThatOfASearchThroughAll) {
  const CoarseBall ball(1, kOuter_m);
  const NearestOnSurface surface(ball.triangles, ball.points_m);
  for (int i = 0; i < 60; ++i) {
    const Vec3d place = (i % 3 == 0 ? 1.2 : 1.0) * placeInWall(i);
    double best = 1;
    constexpr int kParts = 100;
    for (const Triangle& t : ball.triangles)
      for (int u = 0; u <= kParts; ++u)
        for (int v = 0; u + v <= kParts; ++v) {
          const Vec3d p = 1.0 / kParts *
                          ((kParts - u - v) * toDouble(ball.points_m[t[0]]) +
                           u * toDouble(ball.points_m[t[1]]) + v * toDouble(ball.points_m[t[2]]));
          best = std::min(best, length(p - place));
        }
    const double found = length(surface.to(toFloat(place)) - place);
    EXPECT_LT(found, best + 1e-7) << i;
    EXPECT_GT(found, best - 2e-4) << i;  // of that between the oracle's places
  }
}

}  // namespace
}  // namespace echocine
