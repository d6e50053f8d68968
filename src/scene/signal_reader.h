#pragma once
// The [signal] table of a scene, and its look.

#include "scene/scene.h"
#include "scene/toml_table.h"

namespace echocine {

// Reads signal.look and signal.quality and gives the scene their values, as defaults of the keys
// that are read after it.
void takeLook(TomlTable signal, Scene& scene);

// Sets scene.signal.
void readSignal(TomlTable table, Scene& scene);

}  // namespace echocine
