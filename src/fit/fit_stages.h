#pragma once
// Stages of a fit and their share of its progress.

#include <algorithm>

#include "fit/fit_polish.h"
#include "fit/fit_progress.h"
#include "fit/heart_design.h"
#include "fit/heart_fit.h"
#include "fit/own_loop.h"
#include "scene/looks.h"

namespace echocine::fit {

// In units of FitProgress. With own look, the look of own loops is chosen, the planes of the best
// descent are mirrored in turn, those descents that end apart have a look and a polish, and the
// best one has them twice and then takes steps, each with a new look.
struct FitStages {
  double hearts, families, starts, descent, resamples, own;
  double choice = 0, look = 0, pair = 0, step = 0, settle = 0;  // pair: of places of a polish
  std::size_t descents, mirrored = 0;
  std::size_t unknowns, all_unknowns;  // of a view: of descents, and with those held in them
  FitStages(std::size_t views, const HeartDesign& design, const HeartFitOptions& options)
      : descents(static_cast<std::size_t>(std::min(options.descents, options.starts))) {
    const auto n = static_cast<double>(views);
    hearts = kHeartUnits * static_cast<double>(design.size());
    families = kFamilyUnits * n * static_cast<double>(design.size());
    starts = kStartUnits * n * options.starts;
    unknowns = all_unknowns = design.ranges().size() + (options.tilt_deg > 0 ? 2 : 0);
    if (options.ownLook(views))
      for (const DialRange& range : design.ranges())
        unknowns -= heart::isSectionDial(range.key) ? 1 : 0;
    descent = descentUnits(n, static_cast<double>(unknowns));
    if (options.ownLook(views)) {
      look = kOwnLoopUnits * n;
      choice = static_cast<double>(scannerLooks().size()) / kTwins * look;
      pair = n * kEvaluationUnits * 2;
      step = pair * static_cast<double>(all_unknowns);
      settle = options.settling_steps * (look + step);
      if (options.tilt_deg > 0) mirrored = views;
    }
    resamples = descent * options.resamples;
    own = options.own_loops ? kOwnLoopUnits * n + descent + polish(kPolishRounds, unknowns) : 0;
  }
  double polish(std::size_t rounds, std::size_t of_unknowns) const {
    return pair * static_cast<double>(rounds * polishPairs(of_unknowns));
  }
  double all() const {
    const auto all_descents = static_cast<double>(descents + mirrored);
    constexpr double kUsuallyApart = 2;  // ends of descents that have a look; measured
    return hearts + families + starts + descent * all_descents + choice +
           (look + polish(kFirstPolishRounds, unknowns)) * std::min(kUsuallyApart, all_descents) +
           look + polish(kFirstPolishRounds, all_unknowns) + settle + resamples + own;
  }
};

}  // namespace echocine::fit
