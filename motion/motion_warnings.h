#pragma once
// What the loop's frames between keyframes suffer, in words.

#include <string>
#include <vector>

#include "motion/mesh_motion.h"

namespace echocine {

// Looks at every frame of the loop, each phase once; a line per structure with triangles that turn
// over or vanish or with a surface that collapses, naming the first of them. Throws JobError naming
// structure and frame where a closed one is turned inside out: no medium is inside it then.
std::vector<std::string> motionWarnings(const Scene& scene, const MeshMotion& motion);

}  // namespace echocine
