#pragma once
// Creases and corners of lids, in the vertex numbers of the mesh they are joined to.

#include <filesystem>
#include <span>

#include "scene/mesh_tags.h"

namespace echocine {

// Adds a lid's tags to those of the joined mesh. joined_from_lid[v]: the number that the lid's
// vertex v has there. An edge or point that both files tag must have one sharpness; SceneError
// starts with the lid's name.
void joinTags(const MeshTags& lid, std::span<const std::uint32_t> joined_from_lid,
              const std::filesystem::path& file, MeshTags& tags);

}  // namespace echocine
