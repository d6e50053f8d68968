#pragma once
// The [probe] table of a scene.

#include "scene/scene.h"
#include "scene/toml_table.h"

namespace echocine {

// Sets scene.probe, and scene.view where the pose is still to be found; so is the depth where it is
// 0 then, and the focus. Precondition: scene.motion has the unit of the apex. Throws SceneError.
void readProbe(TomlTable table, Scene& scene);

}  // namespace echocine
