#pragma once
// Intervals of a fit's results, and what makes them doubtful.

#include "fit/fit_descent.h"
#include "fit/heart_fit.h"

namespace echocine::fit {

// (15)  SD^2 = inverse curvature of J + model error
// The model error is that of planted hearts with other atria, right ventricles, twist, rates, media
// and looks than the models' (README.md), as SD. EF of three views: of one patient.
struct ModelError {
  double ef, edv, gls;  // SD; that of EDV is relative
};
ModelError modelErrorOf(std::size_t views);

// Fills the results, dials, hints and refusal of a fit from its descents, the best first.
// Precondition: `fit.views` and fixed dials are there.
void concludeFit(const FitCost& cost, const std::vector<FitDescent>& descents, HeartFit& fit);

}  // namespace echocine::fit
