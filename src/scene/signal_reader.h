#pragma once
// The tables of a scene that a look sets: [signal], [trabeculae], [speckle] and [artefacts].

#include "scene/scene.h"
#include "scene/toml_table.h"

namespace echocine {

// Reads signal.look and signal.quality and gives the scene their values, as defaults of the keys
// that are read after it.
void takeLook(TomlTable signal, Scene& scene);

// Each with the defaults that it is given.
SignalSettings readSignal(TomlTable table, const SignalSettings& defaults);
TrabeculaeSettings readTrabeculae(TomlTable table, const TrabeculaeSettings& defaults);
SpeckleSettings readSpeckle(TomlTable table, const SpeckleSettings& defaults);
ArtefactSettings readArtefacts(TomlTable table, const ArtefactSettings& defaults);

}  // namespace echocine
