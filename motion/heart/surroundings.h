#pragma once
// What an echo shows around the heart: chest wall, lungs, the tissue between, the aorta that passes
// behind.

#include <vector>

#include "motion/heart/heart_poses.h"

namespace echocine::heart {

// Still parts for one view, in heart coordinates; all of lower priority than the heart's.
// `sac_reach_m`: as a recording has it.
std::vector<Part> surroundingsOf(View view, const ProbePose& pose, const ParametricHeart& heart,
                                 const std::vector<double>& sac_reach_m);

}  // namespace echocine::heart
