#pragma once
// One [[structure]] of a scene file.

#include <filesystem>
#include <span>

#include "scene/scene.h"
#include "scene/scene_reader.h"
#include "scene/toml_table.h"

namespace echocine {

// Everything except the medium. `folder` is the base of the structure's paths. `phases` are those
// of keyframes without their own, evenly spaced if empty. `meshes`: meshes in memory, see
// parseScene(); nullptr: on disk.
Structure readStructure(TomlTable& table, const std::filesystem::path& folder,
                        std::span<const double> phases, const NamedMeshes* meshes = nullptr);

}  // namespace echocine
