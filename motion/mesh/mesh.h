#pragma once
// A triangle mesh in the form of a file: in the file's own unit and world coordinates.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// More than any keyframe of a heart needs, and few enough for 32-bit indices.
inline constexpr std::size_t kMaxMeshVertices = 20'000'000;
inline constexpr std::size_t kMaxMeshTriangles = 40'000'000;

// The file's face, from 0, of a triangle; `faces` as above.
inline std::size_t fileFace(const std::vector<std::uint32_t>& faces, std::size_t triangle) {
  return faces.empty() ? triangle : faces[triangle];
}

// Appends a face of the file as a fan of triangles. `face`: its number there, from 0. Precondition:
// at least three corners.
void appendFan(std::span<const std::uint32_t> corners, std::size_t face, TriangleMesh& mesh);

// Start of one file's triangles and vertices in a joined mesh. Vertices welded to an earlier file's
// belong to that file.
struct MeshPart {
  std::filesystem::path file;
  std::size_t first_triangle = 0;
  std::size_t first_vertex = 0;
  std::vector<std::uint32_t> faces{};  // as in TriangleMesh; empty: one after the other
  bool filled = false;                 // faces added by a repair over holes, not faces of the file
};

struct KeyframeMesh {
  TriangleMesh mesh;
  std::vector<MeshPart> parts;  // the mesh, then its lids
};

}  // namespace echocine
