#pragma once
// Which vertices of a mesh are one point. Positions are by keyframe, then vertex, in the mesh's
// unit: what parts later, as leaflets do, is not one point.

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// STL and most PLY files hold single precision, and the tracer works in it: a point computed in two
// ways differs by a few units in the last place of its largest coordinate. Our choice: four. Closer
// points are one point to all that follows.
double coincidenceTolerance(const std::vector<std::vector<Vec3d>>& positions);

// Whether two vertices are at the same place in every keyframe.
bool coincide(const std::vector<std::vector<Vec3d>>& positions, double tolerance, std::uint32_t a,
              std::uint32_t b);

// For each vertex the lowest one at its place among those on open edges; itself for all others.
// Precondition: at least one keyframe.
std::vector<std::uint32_t> coincidentOpenVertices(std::span<const Triangle> triangles,
                                                  const std::vector<std::vector<Vec3d>>& positions,
                                                  double tolerance);

}  // namespace echocine
