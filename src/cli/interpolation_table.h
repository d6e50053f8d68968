#pragma once
// echocine plan SCENE.toml --interpolation

#include "scene/scene.h"

namespace echocine {

// Reads the keyframes and prints the error of each kind of interpolation at every other keyframe,
// computed from the rest, per structure and in total. Throws SceneError.
void printInterpolation(const Scene& scene, bool as_json);

}  // namespace echocine
