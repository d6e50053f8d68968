#pragma once
// The hearts from which a fit starts.

#include <vector>

#include "fit/fit_cost.h"

namespace echocine::fit {

struct FitStarts {
  std::vector<FitPlace> places;  // in ascending order of J; not empty
  bool stopped = false;
};

// The healthy mean, the mean of those with an infarct, then draws of the prior, moved into the
// ranges. Planes are those of the view, poses are searched globally. Throws JobError if the monitor
// requests a stop before the first is known. Precondition: count > 0.
FitStarts startPlaces(const FitCost& cost, int count, const Monitor& monitor);

}  // namespace echocine::fit
