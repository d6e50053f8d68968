#pragma once
#include <vector>

#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/volumes.h"
#include "scene/scene.h"

namespace echocine {

// Volumes of closed structures by name, mL.
Volumes structureVolumes(const Scene& scene, const MeshMotion& motion,
                         const SurfaceFrame& surfaces);

// Volumes of each structure at its own keyframes.
std::vector<KeyframeVolume> keyframeVolumes(const Scene& scene, const MeshMotion& motion);

}  // namespace echocine
