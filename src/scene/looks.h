#pragma once
// Looks: sets of defaults for [signal], [trabeculae], [speckle] and [artefacts]. A key that a scene
// names wins.

#include "scene/scene.h"

namespace echocine {

// "paper" changes nothing. "clean" turns on trabeculae and speckle, with a scanner's grey map and
// weaker interface echoes. "scanner" adds nominal gain, noise and artefacts, the more the poorer
// the quality, which no other look reads.
void applyLook(Look look, Quality quality, Scene& scene);

}  // namespace echocine
