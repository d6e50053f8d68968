#pragma once
// Whether a scene's heart is as large as a heart can be.

#include <string>
#include <vector>

#include "motion/surfaces/mesh_motion.h"

namespace echocine {

// At most one line: the first chamber, by its role, whose largest keyframe has a volume that no
// heart has, and the mesh_unit or the mesh_scale that would fit.
std::vector<std::string> sizeWarnings(const Scene& scene, const MeshMotion& motion);

}  // namespace echocine
