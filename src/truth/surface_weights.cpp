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

std::vector<double> vertexAreas(std::span<const Triangle> triangles,
                                std::span<const Vec3d> points_m) {
  std::vector<double> areas(points_m.size(), 0);
  for (const Triangle& t : triangles) {
    const double area = areaOf({points_m[t[0]], points_m[t[1]], points_m[t[2]]});
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
