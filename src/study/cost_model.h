#pragma once
// What a frame costs by counted work: an order of settings that no clock disturbs.

#include "core/work_counts.h"
#include "plan/loop_plan.h"
#include "scene/scene.h"

namespace echocine {

// Milliseconds of one frame on one core, by the counts of its work (of one frame) and weights of
// our choice, taken from the stage times of a study of the heart that ships. Another machine is
// faster or slower as a whole; the order of settings, which is all that is used, is the same
// everywhere, and with it what a tolerance chooses.
double modelledCost_ms(const Scene& scene, const LoopPlan& plan, const WorkCounts& work,
                       std::size_t vertices);

}  // namespace echocine
