#pragma once
// What is true of a recorded heart, for those who test algorithms against it.

#include <string>

#include "motion/heart/recording.h"

namespace echocine::heart {

// Dials, timing, volumes, excursions, wall thickness and places of valves, as JSON.
std::string truthText(const ParametricHeart& heart, const Recording& recording);

}  // namespace echocine::heart
