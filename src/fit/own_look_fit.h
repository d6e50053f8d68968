#pragma once
// The second part of a search, with the look that each descent's heart has in its own loops.

#include <vector>

#include "fit/fit_descent.h"
#include "fit/fit_stages.h"
#include "fit/fitted_sides.h"

namespace echocine::fit {

// Least agreement, the mean of c (Eq. 21) over the views, with which a fit expects an own look. At
// the ends of plain descents, planted hearts had 0.88 to 1, other people's 0.26 to 0.56. Our
// choice.
inline constexpr double kLeastAgreement = 0.7;

struct OwnLookEnd {
  bool stopped = false;
  // By view, of the lowest descent, if the loops do not look like own loops; else empty.
  std::vector<OwnSight> rejected{};
};

// Descends also from the lowest one with each plane's tilt mirrored. Measures the look of each
// descent's heart and polishes the descent with it. J with its own look says how well a heart
// explains the loops, so the lowest one is the best. Its look is measured once more, and it is
// polished again; this look and its cost remain. Descents whose J is far above the lowest, and
// those that end near another one, are dropped, and those with an agreement below
// `least_agreement`. If the monitor stopped it, or none is left, nothing has changed.
// Precondition: `descents` in ascending order of J.
OwnLookEnd polishWithOwnLooks(FittedSides& sides, const std::vector<heart::View>& views,
                              const HeartFitOptions& options, double least_agreement,
                              const FitStages& stages, FitProgress& progress, FitCost& cost,
                              std::vector<FitDescent>& descents);

}  // namespace echocine::fit
