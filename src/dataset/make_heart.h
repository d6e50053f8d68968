#pragma once
// From a draw to the loops of its heart, in memory.

#include "core/monitor.h"
#include "dataset/dataset_loop.h"

namespace echocine::dataset {

// Draws again until a draw has a valid heart (redraw.h). Runs in this thread only. Throws
// SceneError if every draw was impossible; JobError if a loop failed, or the monitor requests a
// stop.
Heart makeHeart(const Spec& spec, int heart, const Monitor& monitor);

}  // namespace echocine::dataset
