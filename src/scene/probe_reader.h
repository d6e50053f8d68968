#pragma once
// [probe] of a scene file.

#include <optional>

#include "scene/probe.h"
#include "scene/toml_table.h"
#include "scene/view_placement.h"

namespace echocine {

// Place and axes of the table are world coordinates, the place in the mesh unit. With `view` the pose
// is still to be found; so is the depth where it is 0, and then the focus where it is. Throws
// SceneError.
Probe readProbe(TomlTable table, double mesh_unit_m, std::optional<ViewPlacement>& view);

}  // namespace echocine
