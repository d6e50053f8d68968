#pragma once
// Decides what a loop computes and by which tracer, once, from its scene and its meshes.

#include <string>

#include "motion/surfaces/mesh_motion.h"
#include "plan/loop_plan.h"

namespace echocine {

// Throws JobError when a frame between keyframes is inside out.
LoopPlan planLoop(const Scene& scene, const MeshMotion& motion);

// One line for a person: tracer, what is on, what is off.
std::string planSummary(const LoopPlan& plan);

}  // namespace echocine
