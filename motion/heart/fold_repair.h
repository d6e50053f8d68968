#pragma once
// No surface of a recorded heart folds.

#include "motion/heart/recording.h"

namespace echocine::heart {

// Smooths out what folds (unfold.h). Throws SceneError naming the dial that is too large or too
// small where a surface cannot be had without folds, or not with the volume it should have: within
// 10 % (our choice), and 0.1 % for the left ventricle's cavity. Runs in parallel.
void repairFolds(Recording& recording);

}  // namespace echocine::heart
