#pragma once
// A scene file in, a checked Scene in SI units out.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace echocine {

// Reads a TOML scene. Paths in it are relative to its folder.
// Throws SceneError `file:line: key: what is wrong, what is accepted`; unknown keys are errors.
Scene readScene(const std::filesystem::path& file);

// The same for a text that is already in memory; `file` is its name in messages and the base of its
// paths.
Scene parseScene(std::string_view text, const std::filesystem::path& file);

// Meshes in memory by the name, without folders, that a scene's keyframes and lids have for them;
// patterns match them too.
using NamedMeshes = std::map<std::string, std::shared_ptr<const TriangleMesh>>;

// The same with meshes that are looked up here and never on disk.
Scene parseScene(std::string_view text, const std::filesystem::path& file,
                 const NamedMeshes& meshes);

}  // namespace echocine
