#pragma once
// Intervals of a fit's results, and what makes them doubtful.

#include "fit/fit_descent.h"
#include "fit/heart_fit.h"

namespace echocine::fit {

// (15)  SD^2 = inverse curvature of J + model error^2
// (23)  model error^2 = m_f^2 + ((1 - a) m_o)^2
// m_f: of planted hearts of the family, with other atria, right ventricles, twist, rates and media
// than the models', by the number of views and whether J expects the own look; m_o: of hearts
// outside it (README.md). a: agreement of the loops with own loops (HeartFit::agreement), 0 to 1.
// None: not measured, kUnmeasuredAgreement.
inline constexpr double kUnmeasuredAgreement = 0.5;  // our choice: that of the patient's heart
ModelError modelErrorOf(std::size_t views, bool own_look, std::optional<double> agreement);

// a of Eq. 23; none unless it was measured in all views.
std::optional<double> agreementOf(const std::vector<ViewFitted>& views);

// Fills the results, dials, hints and refusal of a fit from its descents, the best first.
// Precondition: `fit.views` and fixed dials are there.
void concludeFit(const FitCost& cost, const std::vector<FitDescent>& descents, HeartFit& fit);

}  // namespace echocine::fit
