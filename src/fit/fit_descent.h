#pragma once
// The descent of a fit's cost from one start.

#include "fit/fit_cost.h"

namespace echocine::fit {

struct FitDescent {
  FitPlace best;
  std::vector<double> covariance;  // of the unknowns, row by row; empty if stopped before
  bool stopped = false;
};

inline constexpr int kMostFitRounds = 6;

// Poses are searched globally at the start. Each round takes the minimum of a quadratic through
// differences of the cost, at most two steps of each unknown away, and halves the way until the
// cost falls. It ends when a round gains less than 0.1 or after kMostFitRounds. Stops without an
// error when the monitor requests it.
FitDescent descendFit(const FitCost& cost, const FitPlace& start, const Monitor& monitor);

}  // namespace echocine::fit
