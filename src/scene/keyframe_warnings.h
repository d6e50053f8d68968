#pragma once
// Warnings about lists of keyframes that are valid but unlikely.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// One line `file:line: key: structure: fault` each: a pattern that also matches another structure's
// files, evenly spaced structures with different numbers of keyframes, a loop of many frames
// without motion. Uses file names only, so it can warn before a mesh is rejected.
std::vector<std::string> keyframeWarnings(const Scene& scene);

}  // namespace echocine
