#pragma once
// A structure's keyframes during repair: one set of triangles, and positions of its vertices in
// every keyframe. Changes of triangles apply to all keyframes, so they keep the same faces.

#include <string>
#include <vector>

#include "motion/mesh/mesh.h"

namespace echocine {

struct RepairMesh {
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> source;          // index of the triangle before the repair
  std::vector<std::vector<Vec3d>> positions;  // by keyframe, then vertex; mesh unit
  std::vector<MeshTags> tags;                 // by keyframe
  std::vector<MeshPart> parts;                // of the first keyframe, before the repair
  double tolerance = 0;                       // mesh unit: see coincidenceTolerance

  std::size_t vertexCount() const { return positions.front().size(); }
  std::string faceName(std::size_t triangle) const;  // numbered as in the file
};

// Replaces the triangles: now[i] takes the place of the old triangle kept[i], corner by corner.
// Creases and corners follow; one that loses its edge is rejected. Throws SceneError.
void replaceTriangles(RepairMesh& mesh, std::vector<Triangle> now,
                      const std::vector<std::uint32_t>& kept);

// Removes vertices that no triangle uses and returns their number.
std::size_t dropUnusedVertices(RepairMesh& mesh);

}  // namespace echocine
