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
// cost falls. Mixed derivatives are computed anew where an unknown has moved by more than a step.
// It ends when a round gains less than the noise of the cost or after kMostFitRounds. The last
// round may raise the cost by that noise: the minimum of the quadratic has less noise than a single
// cost. Stops without an error when the monitor requests it.
FitDescent descendFit(const FitCost& cost, const FitPlace& start, const Monitor& monitor);

// A step of Newton's method from a place with these slopes, shortened to at most one step of each
// unknown; `share` of it is taken. J may rise.
FitPlace newtonStep(const FitCost& cost, const FitPlace& from, const std::vector<double>& slopes,
                    const std::vector<double>& covariance, double share);

}  // namespace echocine::fit
