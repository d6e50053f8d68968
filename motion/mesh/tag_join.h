#pragma once
// Creases and corners of lids, renumbered for the joined mesh.

#include <filesystem>
#include <span>

#include "scene/mesh_tags.h"

namespace echocine {

// Adds a lid's tags to those of the joined mesh. joined_from_lid[v]: the joined number of the lid's
// vertex v. An edge or point tagged by both files must have one sharpness; SceneError starts with
// the lid's name.
void joinTags(const MeshTags& lid, std::span<const std::uint32_t> joined_from_lid,
              const std::filesystem::path& file, MeshTags& tags);

}  // namespace echocine
