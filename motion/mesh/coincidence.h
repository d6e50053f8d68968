#pragma once
// Vertices of a mesh that are one point. Positions are by keyframe, then vertex, in the mesh's
// unit. Points that separate later, as leaflets do, are not one point.

#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// STL and most PLY files are in single precision, as is the tracer. A point computed in two ways
// differs by a few units in the last place of its largest coordinate. Our choice: four. Closer
// points are treated as one.
double coincidenceTolerance(const std::vector<std::vector<Vec3d>>& positions);

// Are two vertices at the same place in every keyframe?
bool coincide(const std::vector<std::vector<Vec3d>>& positions, double tolerance, std::uint32_t a,
              std::uint32_t b);

// For each vertex on an open edge, the lowest such vertex at its place; for all others, the vertex
// itself. Precondition: at least one keyframe.
std::vector<std::uint32_t> coincidentOpenVertices(std::span<const Triangle> triangles,
                                                  const std::vector<std::vector<Vec3d>>& positions,
                                                  double tolerance);

}  // namespace echocine
