#pragma once
// A triangle mesh as files hold it: in the file's own unit and world coordinates.

#include <cstddef>
#include <filesystem>
#include <vector>

#include "core/vec3.h"
#include "motion/surface_frame.h"

namespace echocine {

// More than any keyframe of a heart needs, and few enough for every index to fit 32 bits.
inline constexpr std::size_t kMaxMeshVertices = 20'000'000;
inline constexpr std::size_t kMaxMeshTriangles = 40'000'000;

struct TriangleMesh {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
};

// Where one file's triangles and vertices begin in a mesh that was joined from several. Vertices
// that were welded to an earlier file's belong to that file.
struct MeshPart {
  std::filesystem::path file;
  std::size_t first_triangle = 0;
  std::size_t first_vertex = 0;
};

struct KeyframeMesh {
  TriangleMesh mesh;
  std::vector<MeshPart> parts;  // the mesh, then its lids
};

}  // namespace echocine
