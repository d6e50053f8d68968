#pragma once
// echocine plan SCENE.toml --interpolation

#include "scene/scene.h"

namespace echocine {

// Reads the keyframes and prints, per structure and over all, how well each kind of interpolation
// finds every other keyframe from the rest. Throws SceneError.
void printInterpolation(const Scene& scene, bool as_json);

}  // namespace echocine
