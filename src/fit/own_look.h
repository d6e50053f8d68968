#pragma once
// Deviations of own loops, rendered loops of a model, from the model's labels.

#include <array>
#include <functional>
#include <vector>

#include "fit/fit_cost.h"

namespace echocine::fit {

using OwnDiscrepancies = std::vector<const ModelDiscrepancy*>;  // of one view's own loops

// The look of a model, `plain` without one, in its own loops, as far as a loop shows it. The pose
// is the one that a fit without this look found in the loop.
ExpectedLook lookIn(const OwnDiscrepancies& own, const ModelLoop& plain,
                    const ModelDiscrepancy& loop, const FitPose& pose);

// The plain model of these values of the unknowns. Thread-safe.
using PlainModel = std::function<ModelLoop(const std::vector<double>& values)>;

// The slope of Eq. 24 in own loops of a model, by differences. `places`: of each unknown, a value
// below that of the model, this value, and one above. D of a loop is that of the model with the
// look of the other loops: its own would have its noise too. Runs in parallel. Precondition: two
// own loops or more.
ExpectedSlope slopeIn(const OwnDiscrepancies& own, const std::vector<std::array<double, 3>>& places,
                      const PlainModel& modelAt);

}  // namespace echocine::fit
