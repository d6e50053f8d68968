#pragma once
// Four points in parallel lanes.

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/lanes.h"
#include "core/vec3.h"

namespace echocine::heart {

using FourPoints = Vec3<Doubles4>;

inline FourPoints inAllLanes(Vec3d point) {
  return {Doubles4{} + point.x, Doubles4{} + point.y, Doubles4{} + point.z};
}

// From the first on; lanes beyond the end repeat the last point.
inline FourPoints fourPointsAt(const std::vector<Vec3d>& points, std::size_t first) {
  FourPoints four;
  for (std::size_t lane = 0; lane < kDoubleLanes; ++lane) {
    const Vec3d& point = points[std::min(first + lane, points.size() - 1)];
    four.x[lane] = point.x, four.y[lane] = point.y, four.z[lane] = point.z;
  }
  return four;
}

inline void put(const FourPoints& four, std::vector<Vec3d>& points, std::size_t first) {
  const std::size_t count = std::min(kDoubleLanes, points.size() - first);
  for (std::size_t lane = 0; lane < count; ++lane)
    points[first + lane] = {four.x[lane], four.y[lane], four.z[lane]};
}

inline FourPoints where(Mask4 mask, const FourPoints& a, const FourPoints& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

// The largest whole numbers not above.
inline Doubles4 floorOf(Doubles4 a) {
  return Doubles4{std::floor(a[0]), std::floor(a[1]), std::floor(a[2]), std::floor(a[3])};
}

// std::lerp of positive numbers, for t from 0 to 1.
inline Doubles4 blended(Doubles4 a, Doubles4 b, Doubles4 t) {
  const Doubles4 x = a + t * (b - a);
  const Doubles4 within = b > a ? (b > x ? x : b) : (b < x ? x : b);
  return t == 1 ? b : within;
}

}  // namespace echocine::heart
