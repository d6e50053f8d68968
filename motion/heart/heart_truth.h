#pragma once
// Ground truth of a recorded heart, for tests of algorithms.

#include <string>

#include "motion/heart/recording.h"

namespace echocine::heart {

// Dials, timing, volumes, excursions, wall thickness and positions of valves, as JSON.
std::string truthText(const ParametricHeart& heart, const Recording& recording);

}  // namespace echocine::heart
