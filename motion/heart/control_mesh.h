#pragma once
// Triangle meshes that Loop subdivision turns into the surface one has in mind.

#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine::heart {

using Face = Triangle;

struct SphereMesh {
  std::vector<Vec3d> directions;  // unit vectors
  std::vector<Face> faces;
};

// The icosahedron with every edge cut into `frequency` parts, on the unit sphere: all vertices but
// twelve have six neighbours, where Loop surfaces are smoothest. One vertex stands at (0, 0, -1).
SphereMesh geodesicSphere(int frequency);

// The points of a surface given as a function of direction.
template <typename PointOf>
std::vector<Vec3d> pointsOn(const SphereMesh& sphere, const PointOf& pointOf) {
  std::vector<Vec3d> points;
  points.reserve(sphere.directions.size());
  for (const Vec3d direction : sphere.directions) points.push_back(pointOf(direction));
  return points;
}

// Unit normal of such a surface, outward where the map keeps the sphere's orientation.
template <typename PointOf>
Vec3d normalOf(const PointOf& pointOf, Vec3d direction) {
  constexpr double kStep = 0.05;
  const Vec3d helper = std::abs(direction.z) < 0.7 ? Vec3d{0, 0, 1} : Vec3d{1, 0, 0};
  const Vec3d u = normalised(cross(helper, direction)), v = cross(direction, u);
  const auto along = [&](Vec3d tangent) {
    return pointOf(normalised(direction + kStep * tangent)) -
           pointOf(normalised(direction - kStep * tangent));
  };
  return normalised(cross(along(u), along(v)));
}

// Faces of a sheet of rows x columns vertices, row after row, all diagonals alike.
std::vector<Face> sheetFaces(int rows, int columns);
std::array<std::uint32_t, 4> sheetCorners(int rows, int columns);

// As files hold them. Never minus zero.
inline Vec3d toMicrometre(Vec3d p) {
  const auto rounded = [](double metres) { return std::round(metres * 1e6) * 1e-6 + 0.0; };
  return {rounded(p.x), rounded(p.y), rounded(p.z)};
}

// Volume within a closed mesh.
double volumeOf(const std::vector<Vec3d>& points, const std::vector<Face>& faces);

// Control points whose Loop limit surface passes through `points`: Loop pulls a convex surface
// inwards, by 3 % of the volume of a chamber of 500 vertices. `corners` are tagged sharp, so that
// they stay where they are.
std::vector<Vec3d> loopControlPoints(const std::vector<Vec3d>& points,
                                     const std::vector<Face>& faces,
                                     std::span<const std::uint32_t> corners = {});

}  // namespace echocine::heart
