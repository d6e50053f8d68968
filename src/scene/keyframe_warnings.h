#pragma once
// Lists of keyframes that can be used but are hardly what was meant.

#include <string>
#include <vector>

#include "scene/scene.h"

namespace echocine {

// One line `file:line: key: structure: what looks wrong` each: a pattern that takes another
// structure's files too, evenly spaced structures with different numbers of keyframes, a loop of
// many frames in which nothing moves. Looks at the files' names only, so that it can speak before a
// mesh is refused.
std::vector<std::string> keyframeWarnings(const Scene& scene);

}  // namespace echocine
