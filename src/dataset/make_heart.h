#pragma once
// From a draw to the loops of its heart, in memory.

#include "core/monitor.h"
#include "dataset/dataset_loop.h"

namespace echocine::dataset {

// Draws again while no heart fulfils a draw (redraw.h). Runs in this thread alone. Throws
// SceneError where every attempt was impossible; JobError where a loop failed, or the monitor wants
// to stop.
Heart makeHeart(const Spec& spec, int heart, const Monitor& monitor);

}  // namespace echocine::dataset
