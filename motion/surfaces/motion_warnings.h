#pragma once
// Warnings about the loop's frames between keyframes.

#include <string>
#include <vector>

#include "motion/surfaces/mesh_motion.h"

namespace echocine {

// Examines every frame of the loop, each phase once. One line per structure with inverted,
// vanishing or collapsing parts, naming the first; one if a volume leaves the range of both
// adjacent keyframes by more than 1 % of the end-diastolic volume; one if the last keyframe repeats
// the first. Throws JobError naming structure and frame if a closed surface is inverted: it then
// encloses no medium.
std::vector<std::string> motionWarnings(const Scene& scene, const MeshMotion& motion);

// The error only, in a fraction of the time.
void refuseInverted(const Scene& scene, const MeshMotion& motion);

}  // namespace echocine
