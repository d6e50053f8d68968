#pragma once
// Plans a loop's effects and tracer once, from scene and meshes.

#include <string>

#include "motion/surfaces/mesh_motion.h"
#include "plan/loop_plan.h"

namespace echocine {

// Throws JobError if a surface is inverted between keyframes.
LoopPlan planLoop(const Scene& scene, const MeshMotion& motion);

// One line for the terminal: tracer, enabled and disabled effects.
std::string planSummary(const LoopPlan& plan);

}  // namespace echocine
