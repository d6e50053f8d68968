#pragma once
// Triangle meshes that Loop subdivision turns into the surface one has in mind.

#include <array>
#include <cmath>
#include <cstddef>
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
// Each is made once; the reference stays good.
const SphereMesh& geodesicSphere(int frequency);

// The points of a surface given as a function of direction.
template <typename PointOf>
std::vector<Vec3d> pointsOn(const SphereMesh& sphere, const PointOf& pointOf) {
  std::vector<Vec3d> points;
  points.reserve(sphere.directions.size());
  for (const Vec3d direction : sphere.directions) points.push_back(pointOf(direction));
  return points;
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

// Finds control points whose Loop limit surface passes through given points: Loop pulls a convex
// surface inwards, by 3 % of the volume of a chamber of 500 vertices.
class LoopFit {
 public:
  // `corners` are tagged sharp, so that they stay where they are.
  LoopFit(std::size_t vertex_count, const std::vector<Face>& faces,
          std::span<const std::uint32_t> corners = {});

  std::vector<Vec3d> controlPoints(const std::vector<Vec3d>& points) const;

 private:
  std::vector<std::uint32_t> first_;   // of each vertex's entries in others_
  std::vector<std::uint32_t> others_;  // neighbours that count in the vertex's limit
  std::vector<double> weights_;        // of each of them
  std::vector<std::uint32_t> corners_;
};

// The same for one surface.
std::vector<Vec3d> loopControlPoints(const std::vector<Vec3d>& points,
                                     const std::vector<Face>& faces,
                                     std::span<const std::uint32_t> corners = {});

}  // namespace echocine::heart
