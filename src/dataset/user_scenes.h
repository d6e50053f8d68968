#pragma once
// Scenes of the user in place of the parametric heart: their hearts, imaged as the spec draws it.

#include "core/hash.h"
#include "dataset/draws.h"

namespace echocine::dataset {

// The key `scenes`, if it is there: files relative to the spec's folder, each a population of its
// own. Their texts and all bytes of their meshes go into `digest`. Throws SceneError naming the
// key: what cannot be read, and scenes without what truth needs.
void readUserScenes(TomlTable& file, Spec& spec, Sha256& digest);

// Each view is found in each scene. Throws SceneError.
void checkUserScenes(const Spec& spec);

// The text of a drawn heart's scene with values put at its keys ("signal.gain_db"), read; its probe
// in a standard view. Precondition: the spec has scenes. Throws SceneError.
Scene userScene(const Spec& spec, const Draw& draw, View view,
                const std::vector<std::pair<std::string, TomlValue>>& values);

}  // namespace echocine::dataset
