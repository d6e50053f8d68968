#pragma once
// A time gain that depends on depth only: signal.tgc = "mean".

#include <vector>

#include "motion/surfaces/mesh_motion.h"
#include "plan/loop_plan.h"

namespace echocine {

// For the depth of each sample: the mean of exp(-A) over all lines that reach it and over evenly
// spaced phases of the beat. It never rises with depth and is at least 1e-20 (200 dB), the limit of
// any scanner's gain. The mean is of intensities, not of nepers, so a few lines through lung or
// bone change it by their share, not by hundreds of decibels. Rays are straight and along the
// lines.
std::vector<double> meanLoss(const Scene& scene, const MeshMotion& motion, const LoopPlan& plan);

}  // namespace echocine
