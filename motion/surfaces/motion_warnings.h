#pragma once
// What the loop's frames between keyframes suffer, in words.

#include <string>
#include <vector>

#include "motion/surfaces/mesh_motion.h"

namespace echocine {

// Looks at every frame of the loop, each phase once; a line per structure with triangles that turn
// over or vanish or with a surface that collapses, naming the first of them, one
// where a volume leaves the range of both keyframes beside the frame by over 1 % of the
// end-diastolic volume, and one where the last keyframe is the first again. Throws JobError naming
// structure and frame where a closed one is turned inside out: no medium is inside it then.
std::vector<std::string> motionWarnings(const Scene& scene, const MeshMotion& motion);

}  // namespace echocine
