#pragma once
// Settings of a scene that exclude each other.

#include "scene/scene.h"
#include "scene/toml_table.h"

namespace echocine {

// Throws SceneError that names both keys of the first pair that excludes each other. root: the
// scene's file.
void refuseContradictions(TomlTable& root, const Scene& scene);

}  // namespace echocine
