#pragma once
// The [probe] table of a scene.

#include "scene/scene.h"
#include "scene/toml_table.h"

namespace echocine {

// Sets scene.probe. Sets scene.view if the pose is still to be computed; a depth or focus of 0 then
// is too. Precondition: scene.motion has the unit of the apex. Throws SceneError.
void readProbe(TomlTable table, Scene& scene);

}  // namespace echocine
