#pragma once
// The surroundings of the heart in an echo: chest wall, lungs, tissue between them, descending
// aorta.

#include <vector>

#include "motion/heart/heart_poses.h"

namespace echocine::heart {

// Static parts for one view, in heart coordinates, with lower priority than the heart.
// `sac_reach_m`: from a recording.
std::vector<Part> surroundingsOf(View view, const ProbePose& pose, const ParametricHeart& heart,
                                 const std::vector<double>& sac_reach_m);

}  // namespace echocine::heart
