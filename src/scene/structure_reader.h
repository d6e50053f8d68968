#pragma once
// One [[structure]] of a scene file.

#include <filesystem>

#include "scene/scene.h"
#include "scene/toml_table.h"

namespace echocine {

// Everything but the medium. `folder` is the base of the structure's paths.
Structure readStructure(TomlTable& table, const std::filesystem::path& folder);

}  // namespace echocine
