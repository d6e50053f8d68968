#pragma once
// A triangle mesh from a file or a caller, in its own unit and world coordinates.

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec3.h"
#include "scene/mesh_tags.h"

namespace echocine {

using Triangle =
    std::array<std::uint32_t, 3>;  // vertex indices, counter-clockwise seen from outside

struct TriangleMesh {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  MeshTags tags{};  // OBJ files only
  // Face of the file, from 0, of each triangle; empty if all faces are triangles.
  std::vector<std::uint32_t> faces{};
};

}  // namespace echocine
