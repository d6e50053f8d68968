#pragma once
// [probe] of a scene file.

#include "scene/probe.h"
#include "scene/toml_table.h"

namespace echocine {

// Place and axes of the table are world coordinates, the place in the mesh unit. Throws SceneError.
Probe readProbe(TomlTable table, double mesh_unit_m);

}  // namespace echocine
