#pragma once
// Makes the surfaces of a recorded heart free of folds.

#include "motion/heart/recording.h"

namespace echocine::heart {

// Smooths folds (unfold.h). Throws SceneError naming the dial to change if a surface without folds,
// or with its required volume, is impossible. The tolerance of the volume is 10 % (our choice), and
// 0.1 % for the cavity of the left ventricle. Runs in parallel.
void repairFolds(Recording& recording);

}  // namespace echocine::heart
