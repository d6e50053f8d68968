#pragma once
// Triangle meshes whose Loop limit surface is a given surface.

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/lanes.h"
#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine::heart {

using Face = Triangle;

struct SphereMesh {
  std::vector<Vec3d> directions;  // unit vectors
  std::vector<Face> faces;
};

// An icosahedron with every edge divided into `frequency` parts, projected on the unit sphere. All
// vertices except twelve have six neighbours, where Loop surfaces are smoothest. One vertex is (0,
// 0, -1). Meshes are cached; the reference stays valid.
const SphereMesh& geodesicSphere(int frequency);

// The points of a surface defined as a function of direction.
template <typename PointOf>
std::vector<Vec3d> pointsOn(const SphereMesh& sphere, const PointOf& pointOf) {
  std::vector<Vec3d> points;
  points.reserve(sphere.directions.size());
  for (const Vec3d direction : sphere.directions) points.push_back(pointOf(direction));
  return points;
}

// Faces of a sheet of rows x columns vertices, row by row, with parallel diagonals.
std::vector<Face> sheetFaces(int rows, int columns);
std::array<std::uint32_t, 4> sheetCorners(int rows, int columns);

// Rounded to a micrometre, as in files. Never minus zero.
inline Vec3d toMicrometre(Vec3d p) {
  const auto rounded = [](double metres) { return std::round(metres * 1e6) * 1e-6 + 0.0; };
  return {rounded(p.x), rounded(p.y), rounded(p.z)};
}

// Volume within a closed mesh.
double volumeOf(const std::vector<Vec3d>& points, const std::vector<Face>& faces);

// Computes control points whose Loop limit surface interpolates given points: without this, Loop
// subdivision shrinks a convex surface, by 3 % of the volume for a chamber of 500 vertices.
class LoopFit {
 public:
  // `corners` are tagged as sharp, so that they keep their places.
  LoopFit(std::size_t vertex_count, const std::vector<Face>& faces,
          std::span<const std::uint32_t> corners = {});

  // One entry per instant.
  std::vector<std::vector<Vec3d>> controlPoints(std::span<const std::vector<Vec3d>> instants) const;

 private:
  struct FourPoints {  // a vertex at four instants, in parallel lanes
    Doubles4 x, y, z;
  };
  std::vector<FourPoints> controlPoints(const std::vector<FourPoints>& wanted) const;

  std::vector<std::uint32_t> first_;   // start of each vertex's entries in others_
  std::vector<std::uint32_t> others_;  // neighbours with a weight in the vertex's limit
  std::vector<double> weights_;        // one per entry of others_
  std::vector<std::uint32_t> corners_;
};

}  // namespace echocine::heart
