#pragma once
// Stages of a fit and their share of its progress.

#include <algorithm>

#include "fit/fit_polish.h"
#include "fit/fit_progress.h"
#include "fit/heart_fit.h"
#include "fit/own_loop.h"
#include "scene/looks.h"

namespace echocine::fit {

// In units of FitProgress. With own look, the look of own loops is chosen, the planes of the best
// descent are mirrored in turn, those descents that end apart have a look and a polish, and the
// best one has them twice and then takes steps, each with a new look.
struct FitStages {
  double hearts, families, starts, descent, resamples, own;
  double choice = 0, look = 0, polish_round = 0, last_polish_round = 0, step = 0, settle = 0;
  std::size_t descents, mirrored = 0;
  // sections: of the dials, those of heart::SectionShape.
  FitStages(std::size_t views, std::size_t hearts_made, std::size_t dials, std::size_t sections,
            const HeartFitOptions& options)
      : descents(static_cast<std::size_t>(std::min(options.descents, options.starts))) {
    const auto n = static_cast<double>(views);
    hearts = kHeartUnits * static_cast<double>(hearts_made);
    families = kFamilyUnits * n;
    starts = kStartUnits * n * options.starts;
    const std::size_t all = dials + (options.tilt_deg > 0 ? 2 : 0),
                      unknowns = options.ownLook(views) ? all - sections : all;
    descent = descentUnits(n, static_cast<double>(unknowns));
    if (options.ownLook(views)) {
      look = kOwnLoopUnits * n;
      choice = static_cast<double>(scannerLooks().size()) / kTwins * look;
      polish_round = n * kEvaluationUnits * 2 * static_cast<double>(polishPairs(unknowns));
      last_polish_round = n * kEvaluationUnits * 2 * static_cast<double>(polishPairs(all));
      step = n * kEvaluationUnits * 2 * static_cast<double>(all);
      settle = options.settling_steps * (look + step);
      if (options.tilt_deg > 0) mirrored = views;
    }
    resamples = descent * options.resamples;
    own = options.own_loops ? kOwnLoopUnits * n + descent + polish(kPolishRounds) : 0;
  }
  double polish(std::size_t rounds) const { return static_cast<double>(rounds) * polish_round; }
  double lastPolish() const { return static_cast<double>(kFirstPolishRounds) * last_polish_round; }
  double all() const {
    const auto all_descents = static_cast<double>(descents + mirrored);
    constexpr double kUsuallyApart = 2;  // ends of descents that have a look; measured
    return hearts + families + starts + descent * all_descents + choice +
           (look + polish(kFirstPolishRounds)) * std::min(kUsuallyApart, all_descents) + look +
           lastPolish() + settle + resamples + own;
  }
};

}  // namespace echocine::fit
