#pragma once
// Intervals of a fit's results, and what makes them doubtful.

#include "fit/fit_descent.h"
#include "fit/heart_fit.h"

namespace echocine::fit {

// (15)  SD^2 = inverse curvature of J + model error^2
// (23)  model error^2 = m_f^2 + ((1 - a) m_o)^2 + (m_l l)^2
// m_f: of planted hearts of the family, with other atria, right ventricles, twist, rates and media
// than the models', by the number of views and whether J expects the own look; m_o: of hearts
// outside it (README.md). a: agreement of the loops with own loops (HeartFit::agreement), 0 to 1.
// None: not measured, kUnmeasuredAgreement. l: lag of Eq. 26, in beats, mean of the views; m_l: 0.6
// of the ejection fraction, 0.35 of the strain. Averaging over time hides the smallest cavity: EF
// of one-view fits was lower by 0.5 to 1.3 l.
inline constexpr double kUnmeasuredAgreement = 0.5;  // our choice: that of the patient's heart
ModelError modelErrorOf(std::size_t views, bool own_look, std::optional<double> agreement,
                        double lag_beats = 0);

// a of Eq. 23 of all views.
double agreementOf(const std::vector<OwnSight>& sights);
// The same; none unless it was measured in all views.
std::optional<double> agreementOf(const std::vector<ViewFitted>& views);

// l of Eq. 23.
double lagBeatsOf(const std::vector<ViewFitted>& views);

// Fills the results, dials, hints and refusal of a fit from its descents, the best first.
// Precondition: `fit.views` and fixed dials are there.
void concludeFit(const FitCost& cost, const std::vector<FitDescent>& descents, HeartFit& fit);

}  // namespace echocine::fit
