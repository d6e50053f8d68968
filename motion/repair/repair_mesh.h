#pragma once
// A structure's keyframes while they are repaired: one set of triangles, the places of its vertices
// in every keyframe. What is done to the triangles is done to all keyframes at once, so they keep
// the same faces.

#include <string>
#include <vector>

#include "motion/mesh.h"

namespace echocine {

struct RepairMesh {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> source;          // the triangle it was before the repair
  std::vector<std::vector<Vec3d>> positions;  // by keyframe, then vertex; mesh unit
  std::vector<MeshTags> tags;                 // by keyframe
  std::vector<MeshPart> parts;                // of the first keyframe, before the repair
  double tolerance = 0;                       // mesh unit: see coincidenceTolerance

  std::size_t vertexCount() const { return positions.front().size(); }
  std::string faceName(std::size_t triangle) const;  // as the file numbers it
};

// STL and most PLY files hold single precision, and the tracer works in it: a point computed in two
// ways differs by a few units in the last place of its largest coordinate. Our choice: four. Closer
// points are one point to all that follows.
double coincidenceTolerance(const std::vector<std::vector<Vec3d>>& positions);

// Whether two vertices are at the same place in every keyframe: what parts later, as leaflets do,
// is not one point.
bool coincide(const RepairMesh& mesh, std::uint32_t a, std::uint32_t b);

// Replaces the triangles: now[i] takes the place of the old triangle kept[i], corner by corner.
// Creases and corners follow; one that loses its edge is refused. Throws SceneError.
void replaceTriangles(RepairMesh& mesh, std::vector<Triangle> now,
                      const std::vector<std::uint32_t>& kept);

// Removes vertices that no triangle uses and returns their number.
std::size_t dropUnusedVertices(RepairMesh& mesh);

}  // namespace echocine
