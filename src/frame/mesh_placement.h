#pragma once
// The position of a scene's meshes relative to its probe, as a message.

#include <string>

#include "core/box.h"
#include "motion/surfaces/mesh_motion.h"
#include "scene/scene.h"

namespace echocine {

// Bounding box of all surfaces at eight phases of the beat, probe frame, m. Empty without surfaces.
Box meshesBox(const MeshMotion& motion);

// A clause without a full stop: the box in mm of the probe's axes, the part within the sector, and
// the centre of the box in the coordinates of probe.apex. Precondition: the box is not empty.
std::string describePlacement(const Scene& scene, const Box& box_m);

}  // namespace echocine
