#pragma once
// The direction of the beam relative to the left ventricle.

#include "motion/surfaces/mesh_motion.h"
#include "scene/scene.h"

namespace echocine {

// The squared sine of the angle between the probe's axis and the long axis of the left ventricle's
// cavity at phase 0: near 0 in apical views, near 1 in parasternal ones. 0 without such a cavity.
double squaredSineToLongAxis(const Scene& scene, const MeshMotion& motion);

}  // namespace echocine
