#pragma once
// Looks: sets of defaults for [signal], [trabeculae], [leaflets], [speckle] and [artefacts]. Keys
// in the scene override them.

#include <vector>

#include "scene/scene.h"

namespace echocine {

// "paper" changes nothing. "clean" turns on trabeculae and speckle, with a scanner's grey map and
// weaker interface echoes. The looks of scanners add an even time gain, noise and artefacts,
// stronger for poorer quality. They differ in pulse, grey map, smoothing and persistence.
void applyLook(Look look, Quality quality, Scene& scene);

// The looks of scanners, in their order.
std::vector<Look> scannerLooks();

}  // namespace echocine
