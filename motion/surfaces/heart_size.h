#pragma once
// Plausibility of the size of a scene's heart.

#include <string>
#include <vector>

#include "motion/surfaces/mesh_motion.h"

namespace echocine {

// At most one line: the first chamber, by role, whose largest keyframe has an implausible volume,
// with a fitting mesh_unit or mesh_scale.
std::vector<std::string> sizeWarnings(const Scene& scene, const MeshMotion& motion);

}  // namespace echocine
