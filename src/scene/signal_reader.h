#pragma once
// The [signal] table of a scene, and its look.

#include "scene/scene.h"
#include "scene/toml_table.h"

namespace echocine {

// Reads signal.look and signal.quality and applies them as defaults of the keys read later.
void takeLook(TomlTable signal, Scene& scene);

// Sets scene.signal.
void readSignal(TomlTable table, Scene& scene);

}  // namespace echocine
