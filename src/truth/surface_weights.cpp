#include "truth/surface_weights.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "motion/views/facets.h"

namespace echocine {

namespace {

Facet facetOf(const Triangle& t, std::span<const Vec3f> p) {
  return {toDouble(p[t[0]]), toDouble(p[t[1]]), toDouble(p[t[2]])};
}

}  // namespace

std::vector<double> vertexAreas(std::span<const Triangle> triangles,
                                std::span<const Vec3d> points_m) {
  std::vector<double> areas(points_m.size(), 0);
  for (const Triangle& t : triangles) {
    const double area = areaOf(Facet{points_m[t[0]], points_m[t[1]], points_m[t[2]]});
    for (const std::uint32_t v : t) areas[v] += area / 3;
  }
  return areas;
}

void addCutLengths(std::span<const Triangle> triangles, std::span<const Vec3d> points_m, Vec3d on_m,
                   Vec3d normal, std::vector<double>& weights_m) {
  struct End {
    Vec3d at;
    std::uint32_t from, to;
    double share;  // of `to`
  };
  for (const Triangle& t : triangles) {
    std::array<End, 2> ends{};
    std::size_t n = 0;
    for (std::size_t i = 0; i < 3 && n < 2; ++i) {
      const std::uint32_t from = t[i], to = t[(i + 1) % 3];
      const double a = dot(points_m[from] - on_m, normal), b = dot(points_m[to] - on_m, normal);
      if ((a >= 0) == (b >= 0)) continue;
      const double share = a / (a - b);
      ends[n++] = {points_m[from] + share * (points_m[to] - points_m[from]), from, to, share};
    }
    if (n < 2) continue;
    const double half_m = 0.5 * length(ends[1].at - ends[0].at);
    for (const End& end : ends) {
      weights_m[end.from] += (1 - end.share) * half_m;
      weights_m[end.to] += end.share * half_m;
    }
  }
}

Vec3d surfaceMiddle(std::span<const Triangle> triangles, std::span<const Vec3f> points_m) {
  Facets facets;
  for (const Triangle& t : triangles) facets.push_back(facetOf(t, points_m));
  return middleOf(facets);
}

Vec3d farthestPlace(std::span<const Triangle> triangles, std::span<const Vec3f> points_m,
                    Vec3d base_m) {
  constexpr double kApexShare = 0.03;
  double farthest_m = 0;
  for (const Vec3f p : points_m) farthest_m = std::max(farthest_m, length(toDouble(p) - base_m));
  const double least_m = (1 - kApexShare) * farthest_m;
  Facets tip;
  for (const Triangle& t : triangles) {
    const Facet f = facetOf(t, points_m);
    addPartAbove(f,
                 {length(f[0] - base_m) - least_m, length(f[1] - base_m) - least_m,
                  length(f[2] - base_m) - least_m},
                 tip);
  }
  if (tip.empty()) return base_m;
  return base_m + farthest_m * normalised(middleOf(tip) - base_m);
}

}  // namespace echocine
