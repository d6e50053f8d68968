#pragma once
// A scene file in, a checked Scene in SI units out.

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "scene/scene.h"

namespace echocine {

// Reads a TOML scene. Paths in it are relative to its folder. Throws SceneError `file:line: key:
// fault, accepted values`; unknown keys are errors.
Scene readScene(const std::filesystem::path& file);

// The same for a text in memory; `file` is its name in messages and the base of its paths.
Scene parseScene(std::string_view text, const std::filesystem::path& file);

// Meshes in memory by the names, without folders, that a scene's keyframes and lids use; patterns
// match them too.
using NamedMeshes = std::map<std::string, std::shared_ptr<const TriangleMesh>>;

// The same with meshes from memory only.
Scene parseScene(std::string_view text, const std::filesystem::path& file,
                 const NamedMeshes& meshes);

}  // namespace echocine
