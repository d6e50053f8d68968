#pragma once
// Triangle meshes that Loop subdivision turns into the surface one has in mind.

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec3.h"

namespace echocine::beating_heart {

using Face = std::array<std::uint32_t, 3>;  // counter-clockwise seen from outside

struct SphereMesh {
  std::vector<Vec3d> directions;  // unit vectors
  std::vector<Face> faces;
};

// The icosahedron with every edge cut into `frequency` parts, on the unit sphere: all vertices but
// twelve have six neighbours, where Loop surfaces are smoothest. One vertex stands at (0, 0, -1).
SphereMesh geodesicSphere(int frequency);

// Faces of a sheet of rows x columns vertices, row after row, all diagonals alike.
std::vector<Face> sheetFaces(int rows, int columns);

// Volume within a closed mesh.
double volumeOf(const std::vector<Vec3d>& points, const std::vector<Face>& faces);

// Control points whose Loop limit surface passes through `points`: Loop pulls a convex surface
// inwards, by 3 % of the volume of a chamber with these meshes. Corners of a sheet stay where they
// are.
std::vector<Vec3d> loopControlPoints(const std::vector<Vec3d>& points,
                                     const std::vector<Face>& faces);

}  // namespace echocine::beating_heart
