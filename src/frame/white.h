#pragma once
// White of a loop's log compression, measured over frames.

#include <functional>
#include <optional>
#include <span>

#include "core/monitor.h"
#include "motion/cycle/frame_time.h"
#include "motion/volumes.h"

namespace echocine {

class Simulator;
struct PolarFrame;

// Gets the frames that were traced, by their numbers, one at a time and in order.
using KeepTraced = std::function<void(int frame, PolarFrame&& polar, Volumes&& volumes_ml)>;

// signal.reference_intensity where the scene has it, else the percentile over still frames at these
// instants, as many at once as the threads allow. Where there is nothing to be seen the percentile
// would paint an even nothing white; white is then the transmitted intensity, 1. Nothing when the
// monitor stops it.
std::optional<double> measureWhite(const Simulator& simulator, std::span<const FrameTime> times,
                                   const Monitor& monitor, const KeepTraced& keep);

}  // namespace echocine
