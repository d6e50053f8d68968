#pragma once
// Scenes of the user instead of the parametric heart, imaged as the spec draws.

#include "core/hash.h"
#include "dataset/draws.h"

namespace echocine::dataset {

// The key `scenes`, if present: files relative to the spec's folder, each a separate population.
// Their texts and all bytes of their meshes are added to `digest`. Throws SceneError naming the key
// for unreadable scenes, and for scenes that lack structures needed for truth.
void readUserScenes(TomlTable& file, Spec& spec, Sha256& digest);

// Checks that each view can be computed in each scene. Throws SceneError.
void checkUserScenes(const Spec& spec);

// Reads the text of a drawn heart's scene with values at their keys ("signal.gain_db"); its probe
// is in a standard view. Precondition: the spec has scenes. Throws SceneError.
Scene userScene(const Spec& spec, const Draw& draw, View view,
                const std::vector<std::pair<std::string, TomlValue>>& values);

}  // namespace echocine::dataset
