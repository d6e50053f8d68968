#pragma once
// Meshes whose shape is known in closed form. Faces run counter-clockwise seen from outside.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "core/vec3.h"
#include "motion/surfaces/surface_frame.h"

namespace echocine::support {

struct Mesh {
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;

  Mesh moved(Vec3d by) const {
    Mesh copy = *this;
    for (Vec3d& p : copy.points) p = p + by;
    return copy;
  }
  Mesh scaled(double factor) const {
    Mesh copy = *this;
    for (Vec3d& p : copy.points) p = factor * p;
    return copy;
  }
  Mesh insideOut() const {
    Mesh copy = *this;
    for (Triangle& t : copy.triangles) std::swap(t[1], t[2]);
    return copy;
  }
};

inline Mesh octahedron() {
  return {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
          {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
}

inline Mesh icosahedron() {
  const double g = std::numbers::phi;
  Mesh m{{{-1, g, 0},
          {1, g, 0},
          {-1, -g, 0},
          {1, -g, 0},
          {0, -1, g},
          {0, 1, g},
          {0, -1, -g},
          {0, 1, -g},
          {g, 0, -1},
          {g, 0, 1},
          {-g, 0, -1},
          {-g, 0, 1}},
         {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
          {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
          {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (Vec3d& p : m.points) p = normalised(p);
  return m;
}

// Each triangle into four, new vertices put on the unit sphere.
inline Mesh refinedOnSphere(const Mesh& mesh) {
  Mesh fine{mesh.points, {}};
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
  const auto middle = [&](std::uint32_t a, std::uint32_t b) {
    const auto [place, is_new] =
        middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.points.size()));
    if (is_new) fine.points.push_back(normalised(mesh.points[a] + mesh.points[b]));
    return place->second;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.triangles.insert(fine.triangles.end(),
                          {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
  }
  return fine;
}

// 20 * 4^level triangles with their vertices on a sphere about the origin.
inline Mesh icosphere(int level, double radius) {
  Mesh m = icosahedron();
  for (int i = 0; i < level; ++i) m = refinedOnSphere(m);
  return m.scaled(radius);
}

// Symmetric about all three coordinate planes, with whole edges in them: the nasty sphere.
inline Mesh octasphere(int level, double radius) {
  Mesh m = octahedron();
  for (int i = 0; i < level; ++i) m = refinedOnSphere(m);
  return m.scaled(radius);
}

// Poles on the z axis, the seam and every fourth part of a turn exactly in the coordinate planes.
inline Mesh uvSphere(int rings, int segments, double radius) {
  Mesh m;
  m.points.push_back({0, 0, radius});
  for (int r = 1; r < rings; ++r)
    for (int s = 0; s < segments; ++s) {
      const double polar = std::numbers::pi * r / rings, turn = 2 * std::numbers::pi * s / segments;
      const auto snap = [](double v) { return std::abs(v) < 1e-15 ? 0.0 : v; };
      m.points.push_back({radius * std::sin(polar) * snap(std::cos(turn)),
                          radius * std::sin(polar) * snap(std::sin(turn)),
                          radius * snap(std::cos(polar))});
    }
  m.points.push_back({0, 0, -radius});
  const auto at = [&](int r, int s) {
    return static_cast<std::uint32_t>(1 + (r - 1) * segments + s % segments);
  };
  const auto last = static_cast<std::uint32_t>(m.points.size() - 1);
  for (int s = 0; s < segments; ++s) {
    m.triangles.push_back({0, at(1, s), at(1, s + 1)});
    for (int r = 1; r + 1 < rings; ++r) {
      m.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      m.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
    m.triangles.push_back({at(rings - 1, s), last, at(rings - 1, s + 1)});
  }
  return m;
}

inline Mesh box(Vec3d lo, Vec3d hi) {
  Mesh m;
  for (int i = 0; i < 8; ++i)
    m.points.push_back({i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z});
  m.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return m;
}

// An open square of 2 n^2 triangles in the plane z = depth, half-width `half`, front towards -z.
inline Mesh sheet(int n, double half, double depth) {
  Mesh m;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      m.points.push_back({half * (2.0 * i / n - 1), half * (2.0 * j / n - 1), depth});
  const auto at = [n](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      m.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      m.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  return m;
}

inline void writeObj(const Mesh& mesh, const std::filesystem::path& file) {
  std::ofstream out(file);
  out << std::setprecision(17);
  for (const Vec3d& p : mesh.points) out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  for (const Triangle& t : mesh.triangles)
    out << "f " << t[0] + 1 << ' ' << t[1] + 1 << ' ' << t[2] + 1 << '\n';
}

}  // namespace echocine::support
