#pragma once
// What a scanner's time gain is set by: depth alone. signal.tgc = "mean".

#include <vector>

#include "motion/surfaces/mesh_motion.h"
#include "plan/loop_plan.h"

namespace echocine {

// Of each sample's depth: the mean of exp(-A) over all lines and over phases evenly through the
// beat, of lines that have not ended there; never rising with depth, and no less than 1e-20
// (200 dB), beyond which no scanner's gain reaches. Means are of intensities and not of nepers:
// a few lines through lung or bone then change it by their share and not by hundreds of decibels.
// Rays are straight and along the lines.
std::vector<double> meanLoss(const Scene& scene, const MeshMotion& motion, const LoopPlan& plan);

}  // namespace echocine
