#pragma once
// How much of a loop a model claims to explain.

#include "fit/fit_terms.h"

namespace echocine::fit {

// (11)  a = sum over cells of weight, area and sight / area of the real sector,   0 to 1,
// in the mean over the beat: the part of the picture that D is about. The weight is that of
// weighByBlood().
double coverageOf(const ModelLoop& model, const echo::EchoStack& real, const FitPose& pose);

// (12)  V = D^a,   0 to 1 where D is below 1.
// The geometric mean over the sector of what is left: D where the model claims something, 1 where
// it claims nothing. If D is a share of variance that is left, as its region term is, V ranks
// models as the likelihood of the whole picture does: -ln V times half the number of cells is its
// logarithm, up to a constant. D alone favours what claims little.
double pictureDiscrepancy(double discrepancy, double coverage);

}  // namespace echocine::fit
