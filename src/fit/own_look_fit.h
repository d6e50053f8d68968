#pragma once
// The second part of a search, with the look that each descent's heart has in its own loops.

#include <vector>

#include "fit/fit_descent.h"
#include "fit/fit_stages.h"
#include "fit/fitted_sides.h"

namespace echocine::fit {

// Descends also from the lowest one with each plane's tilt mirrored. Measures the look of each
// descent's heart and polishes the descent with it. J with its own look says how well a heart
// explains the loops, so the lowest one is the best. Its look is measured once more, and it is
// polished again; this look and its cost remain. Descents whose J is far above the lowest, and
// those that end near another one, are dropped. False if the monitor stopped it: nothing has
// changed then. Precondition: `descents` in ascending order of J.
bool polishWithOwnLooks(FittedSides& sides, const std::vector<heart::View>& views,
                        const HeartFitOptions& options, const FitStages& stages,
                        FitProgress& progress, FitCost& cost, std::vector<FitDescent>& descents);

}  // namespace echocine::fit
