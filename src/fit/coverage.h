#pragma once
// The share of a loop that a model explains.

#include "fit/fit_terms.h"

namespace echocine::fit {

// (12)  a = sum over cells of weight x area x visibility / area of the real sector,   0 to 1,
// Mean over the beat: the part of the picture that D describes. The weight is that of
// weighByBlood(): the model's Focus is all.
double coverageOf(const ModelLoop& model, const echo::EchoStack& real, const FitPose& pose);

// (13)  V = D^a,   0 to 1 where D is below 1.
// The geometric mean over the sector of D inside the model and 1 outside it. If D is a share of
// variance, as its region term is, V ranks models by the likelihood of the whole picture: -ln V
// times half the number of cells is the log-likelihood, up to a constant. D alone favours models of
// low coverage.
double pictureDiscrepancy(double discrepancy, double coverage);

}  // namespace echocine::fit
