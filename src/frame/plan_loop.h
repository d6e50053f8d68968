#pragma once
// Plans a loop's effects and tracer once, from scene and meshes.

#include <string>

#include "motion/surfaces/mesh_motion.h"
#include "plan/loop_plan.h"

namespace echocine {

// without_warnings: for callers that show none, in less time. Warnings and triangles_met are empty.
enum class PlanWords { with_warnings, without_warnings };

// Throws JobError if a surface is inverted between keyframes.
LoopPlan planLoop(const Scene& scene, const MeshMotion& motion,
                  PlanWords words = PlanWords::with_warnings);

// One line for the terminal: tracer, enabled and disabled effects.
std::string planSummary(const LoopPlan& plan);

}  // namespace echocine
