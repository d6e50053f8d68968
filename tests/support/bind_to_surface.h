#pragma once
// The nearest points of a surface.

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/box.h"
#include "core/check.h"
#include "motion/interior/bound_point.h"

namespace echocine {

struct Nearest {
  double distance2 = 0, b1 = 0, b2 = 0;
};

// The nearest point of a segment's line, held between its ends.
inline double along(Vec3d from, Vec3d to, Vec3d p) {
  const Vec3d d = to - from;
  const double length2 = dot(d, d);
  return length2 > 0 ? std::clamp(dot(p - from, d) / length2, 0.0, 1.0) : 0.0;
}

inline double distanceToSegment(Vec3f p, Vec3f from, Vec3f to) {
  const Vec3d a = toDouble(from), ab = toDouble(to) - a, ap = toDouble(p) - a;
  return length(ap - along(a, a + ab, a + ap) * ab);
}

// Inside the triangle the foot of the perpendicular, else the best of its three edges.
inline Nearest nearestOn(Vec3d a, Vec3d b, Vec3d c, Vec3d p) {
  const Vec3d u = b - a, v = c - a, w = p - a;
  const Vec3d n = cross(u, v);
  const double n2 = dot(n, n);
  if (n2 > 0) {
    const double b1 = dot(cross(w, v), n) / n2, b2 = dot(cross(u, w), n) / n2;
    if (b1 >= 0 && b2 >= 0 && b1 + b2 <= 1) {
      const double height = dot(w, n);
      return {height * height / n2, b1, b2};
    }
  }
  const double ab = along(a, b, p), ac = along(a, c, p), bc = along(b, c, p);
  const auto distance2 = [&](double b1, double b2) {
    const Vec3d d = w - b1 * u - b2 * v;
    return dot(d, d);
  };
  Nearest best{distance2(ab, 0), ab, 0};
  for (const auto& [b1, b2] : {std::pair(0.0, ac), std::pair(1 - bc, bc)})
    if (const double d2 = distance2(b1, b2); d2 < best.distance2) best = {d2, b1, b2};
  return best;
}

// The nearest point of a surface to each of `points_m`. Precondition: at least one triangle.
inline std::vector<BoundPoint> bindToSurface(SurfaceId surface, std::span<const Triangle> triangles,
                                             std::span<const Vec3f> positions_m,
                                             std::span<const Vec3f> points_m) {
  CHECK_LT(std::size_t{0}, triangles.size());
  // A triangle is no nearer than its middle less its reach: most are skipped for that.
  struct Ball {
    Vec3d middle;
    double reach;
  };
  std::vector<Ball> balls;
  for (const Triangle& t : triangles) {
    const Vec3d a = toDouble(positions_m[t[0]]), b = toDouble(positions_m[t[1]]),
                c = toDouble(positions_m[t[2]]);
    const Vec3d middle = (1.0 / 3) * (a + b + c);
    balls.push_back(
        {middle, std::max({length(a - middle), length(b - middle), length(c - middle)})});
  }
  std::vector<BoundPoint> bound;
  for (const Vec3f point : points_m) {
    const Vec3d p = toDouble(point);
    double best = Box::kFar, best_distance = Box::kFar;
    BoundPoint found{surface};
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      if (length(p - balls[i].middle) - balls[i].reach > best_distance) continue;
      const Triangle& t = triangles[i];
      const Nearest nearest = nearestOn(toDouble(positions_m[t[0]]), toDouble(positions_m[t[1]]),
                                        toDouble(positions_m[t[2]]), p);
      if (nearest.distance2 >= best) continue;
      best = nearest.distance2;
      best_distance = std::sqrt(best);
      found = {surface, i, static_cast<float>(nearest.b1), static_cast<float>(nearest.b2)};
    }
    bound.push_back(found);
  }
  return bound;
}

}  // namespace echocine
