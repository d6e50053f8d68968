#pragma once
// Stages of a fit and their share of its progress.

#include <algorithm>

#include "fit/fit_polish.h"
#include "fit/fit_progress.h"
#include "fit/heart_fit.h"

namespace echocine::fit {

// In units of FitProgress. Each descent has a look and a polish, the best one twice.
struct FitStages {
  double hearts, families, starts, descent, resamples, own;
  double look = 0, polish = 0;
  std::size_t descents;
  FitStages(std::size_t views, std::size_t hearts_made, std::size_t dials,
            const HeartFitOptions& options)
      : descents(static_cast<std::size_t>(std::min(options.descents, options.starts))) {
    const auto n = static_cast<double>(views);
    hearts = kHeartUnits * static_cast<double>(hearts_made);
    families = kFamilyUnits * n;
    starts = kStartUnits * n * options.starts;
    const std::size_t unknowns = dials + (options.tilt_deg > 0 ? 2 : 0);
    descent = descentUnits(n, static_cast<double>(unknowns));
    if (options.own_look) {
      look = kOwnLoopUnits * n;
      polish =
          n * kEvaluationUnits * static_cast<double>(kPolishRounds * 2 * polishPairs(unknowns));
    }
    resamples = descent * options.resamples;
    own = options.own_loops ? kOwnLoopUnits * n + descent + polish : 0;
  }
  double all() const {
    return hearts + families + starts + descent * static_cast<double>(descents) +
           (look + polish) * static_cast<double>(descents + 1) + resamples + own;
  }
};

}  // namespace echocine::fit
