#pragma once
// Stages of a fit and their share of its progress.

#include <algorithm>

#include "fit/fit_progress.h"
#include "fit/heart_fit.h"

namespace echocine::fit {

// In units of FitProgress. The second descents, with the own look, take as long as the first.
struct FitStages {
  double hearts, families, starts, descent, look, resamples, own;
  std::size_t descents;
  FitStages(std::size_t views, std::size_t hearts_made, std::size_t dials,
            const HeartFitOptions& options)
      : descents(static_cast<std::size_t>(std::min(options.descents, options.starts))) {
    const auto n = static_cast<double>(views);
    hearts = kHeartUnits * static_cast<double>(hearts_made);
    families = kFamilyUnits * n;
    starts = kStartUnits * n * options.starts;
    descent = descentUnits(n, static_cast<double>(dials) + (options.tilt_deg > 0 ? 2 : 0));
    look = options.own_look ? kOwnLoopUnits * n : 0;
    resamples = descent * options.resamples;
    own = options.own_loops ? kOwnLoopUnits * n + descent : 0;
  }
  double all() const {
    return hearts + families + starts + look +
           descent * static_cast<double>(descents) * (look > 0 ? 2 : 1) + resamples + own;
  }
};

}  // namespace echocine::fit
