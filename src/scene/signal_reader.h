#pragma once
// [signal] and [speckle] of a scene file: from received intensities to the picture's grey.

#include "scene/scene.h"
#include "scene/toml_table.h"

namespace echocine {

// Both throw SceneError.
SignalSettings readSignal(TomlTable table);
SpeckleSettings readSpeckle(TomlTable table);

}  // namespace echocine
