#include "fit/fit_descent.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "fit/fit_progress.h"

namespace echocine::fit {

namespace {

constexpr int kMostHalvings = 3;
constexpr double kNoise = 0.5;    // of J between places a fifth of a step apart; measured
constexpr double kMostSteps = 2;  // of each unknown in a round
constexpr double kFarther = 1;    // steps, beyond which mixed derivatives are computed anew

// The best of a straight way from the place to the quadratic's minimum.
FitPlace taken(const FitCost& cost, const FitPlace& from, const Quadratic& q,
               const std::vector<double>& middle) {
  const std::vector<double> to =
      cost.minimumNear(q, middle, std::vector<double>(middle.size(), kMostSteps));
  FitPlace best = from;
  double share = 1, most = from.cost + kNoise;
  for (int halving = 0; halving <= kMostHalvings; ++halving, share /= 2) {
    std::vector<double> at = from.at;
    for (std::size_t i = 0; i < at.size(); ++i) at[i] += share * (to[i] - from.at[i]);
    FitPlace place = cost.at(at, from.found);
    const bool better = place.cost < most;
    most = std::min(from.cost, better ? place.cost : most);
    if (better)
      best = std::move(place);
    else if (best.cost < from.cost)
      break;
  }
  return best;
}

}  // namespace

FitDescent descendFit(const FitCost& cost, const FitPlace& start, const Monitor& monitor) {
  FitDescent out{start, {}, false};
  try {
    out.best = cost.at(start.at, {});
    std::vector<Quadratic> views;
    std::vector<double> mixed_at;
    for (int round = 0; round < kMostFitRounds; ++round) {
      const std::vector<double> middle = cost.middleOf(out.best.at);
      if (mixed_at.empty() || !cost.within(kFarther, middle, mixed_at)) {
        views.clear();
        mixed_at = middle;
      }
      views = cost.viewsAround(out.best, views, monitor);
      const Quadratic q = cost.sumOf(views, middle);
      out.covariance = cost.covariance(q);
      FitPlace next = taken(cost, out.best, q, middle);
      const double gain = out.best.cost - next.cost;
      out.best = std::move(next);
      monitor.tell({Task::settings, static_cast<std::size_t>(round) + 1,
                    static_cast<std::size_t>(kUsualRounds)});
      if (gain < kNoise) break;
    }
  } catch (const JobError&) {
    if (monitor.keep_going()) throw;
    out.stopped = true;
  }
  return out;
}

FitPlace newtonStep(const FitCost& cost, const FitPlace& from, const std::vector<double>& slopes,
                    const std::vector<double>& covariance, double share) {
  const std::size_t n = from.at.size();
  std::vector<double> steps(n);
  double longest = 1;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) steps[i] -= covariance[i * n + j] * slopes[j];
    steps[i] /= cost.unknowns()[i].step;
    longest = std::max(longest, std::abs(steps[i]));
  }
  for (double& step : steps) step *= share / longest;
  return cost.at(cost.moved(from.at, steps), from.found);
}

}  // namespace echocine::fit
