#pragma once
// White of a loop's log compression, measured over reference frames.

#include <functional>
#include <optional>
#include <span>

#include "core/monitor.h"
#include "motion/cycle/frame_time.h"
#include "motion/surfaces/volumes.h"

namespace echocine {

class Simulator;
struct PolarFrame;

// Receives the traced frames by number, one at a time and in order.
using KeepTraced = std::function<void(int frame, PolarFrame&& polar, Volumes&& volumes_ml)>;

// signal.reference_intensity if given, otherwise the percentile over still frames at these
// instants, as many at once as the threads allow. In an empty picture the percentile would map
// uniform noise to white; white is then the transmitted intensity, 1. None when the monitor stops
// it.
std::optional<double> measureWhite(const Simulator& simulator, std::span<const FrameTime> times,
                                   const Monitor& monitor, const KeepTraced& keep);

}  // namespace echocine
