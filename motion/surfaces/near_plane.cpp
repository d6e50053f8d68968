#include "motion/surfaces/near_plane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace echocine {

void HeightRanges::add(std::span<const Vec3f> positions_m) {
  constexpr float kFar = std::numeric_limits<float>::infinity();
  ranges_m_.resize(positions_m.size(), {kFar, -kFar, 0});
  for (std::size_t v = 0; v < positions_m.size(); ++v) {
    const float y = positions_m[v].y;
    ranges_m_[v] = {std::min(ranges_m_[v].x, y), std::max(ranges_m_[v].y, y), 0};
  }
}

void HeightRanges::refine(const Subdivision& subdivision) {
  std::vector<Vec3f> refined(subdivision.vertexCount());
  subdivision.apply(ranges_m_, refined);
  ranges_m_ = std::move(refined);
}

std::vector<NumberedTriangle> HeightRanges::nearPlane(std::span<const Triangle> triangles,
                                                      double overshoot, double aside_m) const {
  // Single-precision error of blends and stencils, relative to the largest height. Our choice: ten
  // times the sum of a hundred roundings.
  constexpr float kRounding = 1e-4f;
  float largest_m = 0;
  for (const auto& [lo, hi, none] : ranges_m_)
    largest_m = std::max({largest_m, std::abs(lo), std::abs(hi)});
  const auto beyond = static_cast<float>(overshoot), aside = static_cast<float>(aside_m);
  std::vector<NumberedTriangle> near;
  for (std::uint32_t number = 0; number < triangles.size(); ++number) {
    bool above = false, below = false;
    for (const std::uint32_t v : triangles[number]) {
      const auto& [lo, hi, none] = ranges_m_[v];
      const float widen = beyond * (hi - lo) + kRounding * largest_m + aside;
      above |= hi + widen >= 0;
      below |= lo - widen <= 0;
    }
    if (above && below) near.push_back({triangles[number], number});
  }
  return near;
}

std::vector<bool> verticesNearPlane(const SurfaceTopology& surface) {
  std::vector<bool> near(surface.vertex_count, !surface.near_plane);
  if (surface.near_plane)
    for (const NumberedTriangle& t : *surface.near_plane)
      for (const std::uint32_t v : t.corners) near[v] = true;
  return near;
}

}  // namespace echocine
