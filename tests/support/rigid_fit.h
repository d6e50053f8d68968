#pragma once
// Laying one shape onto another by turning and shifting it, and how far apart they then are.

#include <array>
#include <limits>
#include <span>
#include <utility>

#include "support/meshes.h"

namespace echocine::support {

struct RigidMotion {
  std::array<Vec3d, 3> rows{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};
  Vec3d shift;

  Vec3d turned(Vec3d p) const { return {dot(rows[0], p), dot(rows[1], p), dot(rows[2], p)}; }
  Vec3d of(Vec3d p) const { return turned(p) + shift; }
};

// The rotation next to a matrix: Newton's iteration M <- (M + M^-T) / 2 to its polar factor
// (Higham, SIAM J. Sci. Stat. Comput. 7, 1160-1174, 1986). Precondition: determinant over 0.
inline std::array<Vec3d, 3> nearestRotation(std::array<Vec3d, 3> m) {
  for (int i = 0; i < 60; ++i) {
    // Rows of the inverse's transpose are the cofactors over the determinant.
    const std::array<Vec3d, 3> cofactors{cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
    const double determinant = dot(m[0], cofactors[0]);
    // Scaled, so that a matrix of any size gets there soon.
    const double scale = 1 / std::cbrt(determinant);
    for (std::size_t r = 0; r < 3; ++r)
      m[r] = 0.5 * (scale * m[r] + (1 / (scale * determinant)) * cofactors[r]);
  }
  return m;
}

// Least squares of motion.of(from[i]) - to[i] (Arun et al., IEEE PAMI 9, 698-700, 1987).
inline RigidMotion rigidFit(std::span<const Vec3d> from, std::span<const Vec3d> to) {
  const double share = 1.0 / static_cast<double>(from.size());
  Vec3d from_mean, to_mean;
  for (std::size_t i = 0; i < from.size(); ++i) {
    from_mean = from_mean + share * from[i];
    to_mean = to_mean + share * to[i];
  }
  std::array<Vec3d, 3> products{};
  for (std::size_t i = 0; i < from.size(); ++i) {
    const Vec3d p = from[i] - from_mean, q = to[i] - to_mean;
    products[0] = products[0] + q.x * p;
    products[1] = products[1] + q.y * p;
    products[2] = products[2] + q.z * p;
  }
  RigidMotion motion{nearestRotation(products), {}};
  motion.shift = to_mean - motion.turned(from_mean);
  return motion;
}

// The point of a triangle nearest to p (Ericson, Real-Time Collision Detection, 2005, 5.1.5).
inline Vec3d nearestOnTriangle(Vec3d p, Vec3d a, Vec3d b, Vec3d c) {
  const Vec3d ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const double d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp),
               d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const double vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (d4 - d3) / (d4 - d3 + d5 - d6) * (c - b);
  const double whole = va + vb + vc;
  return a + vb / whole * ab + vc / whole * ac;
}

// The nearest point of a surface, by trying every triangle.
inline Vec3d nearestOn(const Mesh& mesh, Vec3d p) {
  Vec3d best;
  double least = std::numeric_limits<double>::infinity();
  for (const Triangle& t : mesh.triangles) {
    const Vec3d q = nearestOnTriangle(p, mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
    const double square = dot(q - p, q - p);
    if (square < least) {
      least = square;
      best = q;
    }
  }
  return best;
}

}  // namespace echocine::support
