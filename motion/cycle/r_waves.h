#pragma once

#include <span>
#include <vector>

#include "motion/cycle/frame_time.h"

namespace echocine {

// R waves of the beats that successive frames belong to, s from the first frame; none before it.
std::vector<double> rWaves(std::span<const FrameTime> frames);

}  // namespace echocine
