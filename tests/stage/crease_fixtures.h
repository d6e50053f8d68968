#pragma once
// Meshes with creases, and what Loop subdivision makes of them.

#include <algorithm>
#include <numbers>

#include "motion/subdivision/subdivision.h"
#include "tests/stage/motion_fixtures.h"

namespace echocine::motion_test {

inline std::vector<Vec3f> floats(const TriangleMesh& mesh) {
  std::vector<Vec3f> positions;
  for (const Vec3d& p : mesh.positions) positions.push_back(toFloat(p));
  return positions;
}

inline TriangleMesh refined(const TriangleMesh& mesh, int levels) {
  const Subdivision loop(mesh.triangles, static_cast<std::uint32_t>(mesh.positions.size()),
                         mesh.tags, levels, {});
  std::vector<Vec3f> fine(loop.vertexCount());
  loop.apply(floats(mesh), fine);
  TriangleMesh result{{}, loop.triangles()};
  for (const Vec3f& p : fine) result.positions.push_back(toDouble(p));
  return result;
}

inline double distanceTo(const TriangleMesh& mesh, Vec3d p) {
  double nearest = 1e30;
  for (const Vec3d& q : mesh.positions) nearest = std::min(nearest, length(q - p));
  return nearest;
}

// Corners at +-1, two triangles a side, all twelve edges infinitely sharp.
inline TriangleMesh creasedCube() {
  TriangleMesh m;
  for (int i = 0; i < 8; ++i)
    m.positions.push_back({i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0});
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  for (std::uint32_t a = 0; a < 8; ++a)
    for (const std::uint32_t bit : {1u, 2u, 4u})
      if (!(a & bit)) m.tags.edges.push_back({a, a | bit, kInfiniteSharpness});
  std::sort(m.tags.edges.begin(), m.tags.edges.end(), [](const SharpEdge& a, const SharpEdge& b) {
    return edgeKey(a.v0, a.v1) < edgeKey(b.v0, b.v1);
  });
  for (std::uint32_t v = 0; v < 8; ++v) m.tags.vertices.push_back({v, kInfiniteSharpness});
  return m;
}

// Axis z, height from -1 to 1, radius 1: rings of n points, hubs in the middle of the caps. Rim
// edges (first and last ring) have the sharpness.
inline TriangleMesh cylinder(std::uint32_t n, std::uint32_t rings, float rim_sharpness) {
  TriangleMesh m;
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t s = 0; s < n; ++s) {
      const double turn = 2 * std::numbers::pi * s / n;
      m.positions.push_back({std::cos(turn), std::sin(turn), 2.0 * r / (rings - 1) - 1});
    }
  const std::uint32_t bottom = n * rings, top = bottom + 1;
  m.positions.push_back({0, 0, -1});
  m.positions.push_back({0, 0, 1});
  for (std::uint32_t s = 0; s < n; ++s) {
    const std::uint32_t t = (s + 1) % n, last = (rings - 1) * n;
    m.triangles.push_back({bottom, t, s});
    m.triangles.push_back({top, last + s, last + t});
    for (std::uint32_t r = 0; r + 1 < rings; ++r) {
      m.triangles.push_back({r * n + s, r * n + t, (r + 1) * n + t});
      m.triangles.push_back({r * n + s, (r + 1) * n + t, (r + 1) * n + s});
    }
    if (rim_sharpness == 0) continue;
    m.tags.edges.push_back({std::min(s, t), std::max(s, t), rim_sharpness});
    m.tags.edges.push_back({last + std::min(s, t), last + std::max(s, t), rim_sharpness});
  }
  return m;
}

}  // namespace echocine::motion_test
