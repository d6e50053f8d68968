#pragma once
// Cost of a frame by counted work: a ranking of settings that does not depend on a clock.

#include "core/work_counts.h"
#include "plan/loop_plan.h"
#include "scene/scene.h"

namespace echocine {

// Milliseconds of one frame on one core, from its counted work and weights of our choice, taken
// from the stage times of a study of the shipped heart. Another machine is faster or slower as a
// whole. Only the ranking of settings is used, which is the same on every machine, and so is the
// choice for a tolerance.
double modelledCost_ms(const Scene& scene, const LoopPlan& plan, const WorkCounts& work,
                       std::size_t vertices);

}  // namespace echocine
