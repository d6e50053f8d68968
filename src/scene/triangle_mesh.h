#pragma once
// A triangle mesh as files and callers hold it: in their own unit and world coordinates.

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
  // The file's face, from 0, that each triangle is of; empty where every face is a triangle.
  std::vector<std::uint32_t> faces{};
};

}  // namespace echocine
