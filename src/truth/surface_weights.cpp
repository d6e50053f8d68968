#include "truth/surface_weights.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace echocine {

namespace {

using Corners = std::array<Vec3d, 3>;

Corners cornersOf(const Triangle& t, std::span<const Vec3f> p) {
  return {toDouble(p[t[0]]), toDouble(p[t[1]]), toDouble(p[t[2]])};
}

double areaOf(const Corners& c) {
  return 0.5 * length(cross(c[1] - c[0], c[2] - c[0]));
}

// The part of a triangle at heights over `least`, heights linear between the corners: its area and
// its middle times that.
struct Part {
  double area = 0;
  Vec3d moment{};
};

Part partAbove(const Corners& c, const std::array<double, 3>& height, double least) {
  std::array<Vec3d, 4> kept{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const double a = height[i] - least, b = height[j] - least;
    if (a >= 0) kept[n++] = c[i];
    if ((a >= 0) != (b >= 0)) kept[n++] = c[i] + (a / (a - b)) * (c[j] - c[i]);
  }
  Part part;
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Corners piece{kept[0], kept[i], kept[i + 1]};
    const double area = areaOf(piece);
    part.area += area;
    part.moment = part.moment + (area / 3) * (piece[0] + piece[1] + piece[2]);
  }
  return part;
}

}  // namespace

namespace {

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
    const Corners corners{part.points_m[t[0]], part.points_m[t[1]], part.points_m[t[2]]};
    const double third = partAbove(corners, heights, 0).area / 3;
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
  Vec3d sum;
  double area = 0;
  for (const Triangle& t : triangles) {
    const Corners c = cornersOf(t, points_m);
    const double of_this = areaOf(c);
    sum = sum + (of_this / 3) * (c[0] + c[1] + c[2]);
    area += of_this;
  }
  return (1 / area) * sum;
}

Vec3d farthestPlace(std::span<const Triangle> triangles, std::span<const Vec3f> points_m,
                    Vec3d base_m) {
  constexpr double kApexShare = 0.03;
  double farthest_m = 0;
  for (const Vec3f p : points_m) farthest_m = std::max(farthest_m, length(toDouble(p) - base_m));
  Part whole;
  for (const Triangle& t : triangles) {
    const Corners c = cornersOf(t, points_m);
    std::array<double, 3> from_base{};
    for (std::size_t i = 0; i < 3; ++i) from_base[i] = length(c[i] - base_m);
    const Part part = partAbove(c, from_base, (1 - kApexShare) * farthest_m);
    whole.area += part.area;
    whole.moment = whole.moment + part.moment;
  }
  if (!(whole.area > 0)) return base_m;
  return base_m + farthest_m * normalised((1 / whole.area) * whole.moment - base_m);
}

}  // namespace echocine
