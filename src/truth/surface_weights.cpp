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

// Shares of a triangle's vertices; vertices outside the part pass theirs on to the others.
std::array<double, 3> keptShares(std::array<double, 3> shares,
                                 const std::array<double, 3>& height) {
  double kept = 0, whole = 0;
  int inside = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    whole += shares[i];
    if (height[i] < 0) continue;
    kept += shares[i];
    ++inside;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (height[i] < 0)
      shares[i] = 0;
    else
      shares[i] = kept > 0 ? shares[i] * whole / kept : whole / inside;
  }
  return shares;
}

std::array<double, 3> heightsOf(const SurfacePart& part, const Triangle& t) {
  return {part.heights[t[0]], part.heights[t[1]], part.heights[t[2]]};
}

// The share of a piece at heights of 0 or more, linear between its ends.
double shareAbove(double a, double b) {
  if (a >= 0 && b >= 0) return 1;
  if (a < 0 && b < 0) return 0;
  return std::max(a, b) / std::abs(a - b);
}

}  // namespace

std::vector<double> vertexAreas(const SurfacePart& part) {
  std::vector<double> areas(part.points_m.size(), 0);
  for (const Triangle& t : part.triangles) {
    const std::array<double, 3> heights = heightsOf(part, t);
    Facets inside;
    addPartAbove({part.points_m[t[0]], part.points_m[t[1]], part.points_m[t[2]]}, heights, inside);
    double third = 0;
    for (const Facet& facet : inside) third += areaOf(facet) / 3;
    const std::array<double, 3> shares = keptShares({third, third, third}, heights);
    for (std::size_t i = 0; i < 3; ++i) areas[t[i]] += shares[i];
  }
  return areas;
}

void addCutLengths(const SurfacePart& part, Vec3d on_m, Vec3d normal,
                   std::vector<double>& weights_m) {
  struct End {
    Vec3d at;
    double height;
  };
  for (const Triangle& t : part.triangles) {
    const std::array<double, 3> heights = heightsOf(part, t);
    std::array<End, 2> ends{};
    std::array<double, 3> shares{};
    std::size_t n = 0;
    for (std::size_t i = 0; i < 3 && n < 2; ++i) {
      const std::size_t j = (i + 1) % 3;
      const Vec3d from_m = part.points_m[t[i]], to_m = part.points_m[t[j]];
      const double a = dot(from_m - on_m, normal), b = dot(to_m - on_m, normal);
      if ((a >= 0) == (b >= 0)) continue;
      const double share = a / (a - b);
      ends[n++] = {from_m + share * (to_m - from_m),
                   heights[i] + share * (heights[j] - heights[i])};
      shares[i] += 0.5 * (1 - share);
      shares[j] += 0.5 * share;
    }
    if (n < 2) continue;
    const double kept_m =
        shareAbove(ends[0].height, ends[1].height) * length(ends[1].at - ends[0].at);
    shares = keptShares(shares, heights);
    for (std::size_t i = 0; i < 3; ++i) weights_m[t[i]] += kept_m * shares[i];
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
