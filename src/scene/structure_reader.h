#pragma once
// One [[structure]] of a scene file.

#include <filesystem>
#include <span>

#include "scene/scene.h"
#include "scene/scene_reader.h"
#include "scene/toml_table.h"

namespace echocine {

// Everything but the medium. `folder` is the base of the structure's paths; `phases` are those of
// keyframes that are given without, evenly spaced where empty.
// `meshes`: where they are in memory, see parseScene(); nullptr: on disk.
Structure readStructure(TomlTable& table, const std::filesystem::path& folder,
                        std::span<const double> phases, const NamedMeshes* meshes = nullptr);

}  // namespace echocine
