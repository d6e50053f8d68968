#include "speckle/nearest_on_surface.h"

#include <algorithm>
#include <array>

namespace echocine {

namespace {

double squared(Vec3d v) {
  return dot(v, v);
}

Vec3d nearestOnEdge(Vec3d a, Vec3d b, Vec3d p) {
  const Vec3d edge = b - a;
  const double size = squared(edge);
  return size > 0 ? a + std::clamp(dot(p - a, edge) / size, 0.0, 1.0) * edge : a;
}

// Within the triangle the foot of the perpendicular; outside, the nearest place of its edges.
Vec3d nearestInTriangle(const std::array<Vec3d, 3>& corner, Vec3d p) {
  const Vec3d normal = cross(corner[1] - corner[0], corner[2] - corner[0]);
  bool inside = squared(normal) > 0;
  Vec3d best = corner[0];
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d a = corner[i], b = corner[(i + 1) % 3];
    inside = inside && dot(cross(b - a, p - a), normal) >= 0;
    const Vec3d near = nearestOnEdge(a, b, p);
    if (squared(near - p) < squared(best - p)) best = near;
  }
  return inside ? p - dot(p - corner[0], normal) / squared(normal) * normal : best;
}

}  // namespace

NearestOnSurface::NearestOnSurface(std::span<const Triangle> triangles,
                                   std::span<const Vec3f> points_m)
    : triangles_(triangles.begin(), triangles.end()),
      points_m_(points_m.begin(), points_m.end()),
      vertices_(points_m),
      starts_(points_m.size() + 1) {
  for (const Triangle& t : triangles_)
    for (const std::uint32_t v : t) ++starts_[v + 1];
  for (std::size_t v = 1; v < starts_.size(); ++v) starts_[v] += starts_[v - 1];
  around_.resize(starts_.back());
  std::vector<std::uint32_t> next = starts_;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    for (const std::uint32_t v : triangles_[t]) around_[next[v]++] = t;
}

Vec3d NearestOnSurface::to(Vec3f place_m) const {
  const std::uint32_t vertex = *vertices_.numberOf(place_m);
  const Vec3d place = toDouble(place_m);
  Vec3d best = toDouble(points_m_[vertex]);
  for (std::uint32_t i = starts_[vertex]; i < starts_[vertex + 1]; ++i) {
    const Triangle& t = triangles_[around_[i]];
    const Vec3d near = nearestInTriangle(
        {toDouble(points_m_[t[0]]), toDouble(points_m_[t[1]]), toDouble(points_m_[t[2]])}, place);
    if (squared(near - place) < squared(best - place)) best = near;
  }
  return best;
}

}  // namespace echocine
