#pragma once
// Where a scene's meshes stand to its probe, in words for whoever placed it blindly.

#include <string>

#include "core/box.h"
#include "motion/surfaces/mesh_motion.h"
#include "scene/scene.h"

namespace echocine {

// Around all surfaces at eight phases of the beat, probe frame, m. Empty without surfaces.
Box meshesBox(const MeshMotion& motion);

// One sentence part without a full stop: the box in mm of the probe's axes, what the sector
// covers of them, and where the box has its middle in the coordinates of probe.apex. Precondition:
// the box is not empty.
std::string describePlacement(const Scene& scene, const Box& box_m);

}  // namespace echocine
