#include "fit/own_look_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "fit/fit_interval.h"
#include "fit/fit_polish.h"
#include "fit/secant_covariance.h"

namespace echocine::fit {

namespace {

// A descent with the look that it ended with.
struct Looked {
  FitDescent descent;
  std::vector<ExpectedLook> looks;
  std::string stage;
};

std::vector<OwnSight> sightsOf(const std::vector<ExpectedLook>& looks) {
  std::vector<OwnSight> out;
  for (const ExpectedLook& look : looks) out.push_back(look.sight().value_or(OwnSight{}));
  return out;
}

// Mean of q c over the views.
double meanShown(const std::vector<ExpectedLook>& looks) {
  double sum = 0;
  for (const OwnSight& sight : sightsOf(looks)) sum += sight.both();
  return sum / static_cast<double>(looks.size());
}

constexpr int kMeanSteps = 3;  // of the last steps; our choice

class LookRounds {
 public:
  LookRounds(FittedSides& sides, const std::vector<heart::View>& views,
             const HeartFitOptions& options, const FitStages& stages, FitProgress& progress,
             const FitCost& plain)
      : sides_(sides),
        views_(views),
        options_(options),
        stages_(stages),
        progress_(progress),
        plain_(plain) {}

  FitCost costOf(const std::string& stage) const {
    return plain_.with(sides_.refer(), {options_.journal, stage});
  }
  // From now on.
  void searchSections() { plain_.searchSections(); }

  // Measures the look of the descent's heart. False if stopped.
  bool look(Looked& one, std::string stage) {
    one.stage = std::move(stage);
    return measure(one, 0);
  }

  // Polishes the descent with its look. False if stopped.
  bool polish(Looked& one) {
    FitDescent& descent = one.descent;
    const double units = stages_.polish(kFirstPolishRounds, plain_.freeOf(0).size());
    descent =
        polishFit(costOf(one.stage), std::move(descent), progress_.next(units), kFirstPolishRounds);
    return !descent.stopped;
  }

  // Newton's method with the look of each place, in loops of its own, as far as the loops show it.
  // The look moves with the heart, so the curvature is not that of one look: the slopes correct it.
  // The result is the mean of the last places: their noise differs. False if stopped.
  bool settle(Looked& one) {
    FitDescent& descent = one.descent;
    const int steps = options_.settling_steps, last = std::min(steps, kMeanSteps);
    if (steps == 0) return true;
    std::vector<double> mean(descent.best.at.size());
    SecantCovariance curvature(descent.covariance);
    for (int step = 1; step <= steps; ++step) {
      one.stage = fmt::format("own look, step {}", step);
      if (!measure(one, step)) return false;
      const Monitor monitor = progress_.next(stages_.step);
      const FitCost cost = costOf(one.stage);
      try {
        const std::vector<double> slopes = cost.slopesAt(descent.best, monitor);
        curvature.add(descent.best.at, slopes);
        descent.best =
            newtonStep(cost, descent.best, slopes, curvature.covariance(), meanShown(one.looks));
      } catch (const JobError&) {
        if (monitor.keep_going()) throw;
        return false;
      }
      for (std::size_t i = 0; i < mean.size() && step > steps - last; ++i)
        mean[i] += descent.best.at[i] / last;
    }
    descent.best = costOf(one.stage).at(mean, descent.best.found);
    return true;
  }

 private:
  // The look of the descent's heart, and J with it. False if stopped.
  bool measure(Looked& one, int round) {
    FitPlace& best = one.descent.best;
    makePossible(plain_, best.at);
    if (!sides_.expectOwnLook(plain_, views_, best, progress_.next(stages_.look), round))
      return false;
    one.looks = sides_.looks;
    best = costOf(one.stage).at(best.at, best.found);
    return true;
  }

  FittedSides& sides_;
  const std::vector<heart::View>& views_;
  const HeartFitOptions& options_;
  const FitStages& stages_;
  FitProgress& progress_;
  FitCost plain_;  // only for its unknowns: its sides change
};

// Descents from the lowest one with the tilt of one plane mirrored, plane by plane. Two planes that
// are tilted by the same angle to either side of the axis of a body of revolution show the same
// section, and the plain J often is lower in the wrong one.
void addMirrored(const FitCost& cost, const FitStages& stages, FitProgress& progress,
                 std::vector<FitDescent>& descents) {
  const FitPlace lowest = descents.front().best;
  for (std::size_t v = 0; v < stages.mirrored; ++v) {
    const Monitor monitor = progress.next(stages.descent);
    const std::size_t tilt = cost.dials() + 2 * v;
    if (std::abs(lowest.at[tilt]) <= cost.unknowns()[tilt].step) continue;
    FitPlace start = lowest;
    start.at[tilt] *= -1;
    descents.push_back(descendFit(cost, start, monitor));
    if (descents.back().stopped) return;
  }
}

// Those that differ and may still become the best.
std::vector<FitDescent> hopefulOf(const FitCost& cost, std::vector<FitDescent> descents) {
  // J of right planes of planted hearts was up to 123 above that of wrong ones. Our choice.
  constexpr double kMostAbove = 150;
  constexpr double kOneMinimum = 2;  // steps of each unknown; a polish joins them. Our choice
  std::stable_sort(descents.begin(), descents.end(), [](const FitDescent& a, const FitDescent& b) {
    return a.best.cost < b.best.cost;
  });
  std::vector<FitDescent> out;
  for (const FitDescent& descent : descents)
    if (descent.best.cost <= descents.front().best.cost + kMostAbove &&
        std::none_of(out.begin(), out.end(), [&](const FitDescent& other) {
          return cost.within(kOneMinimum, other.best.at, descent.best.at);
        }))
      out.push_back(descent);
  return out;
}

// The descents with looks, in ascending order of J; none if the loops agree with none of them.
OwnLookEnd addLooks(LookRounds& rounds, const std::vector<FitDescent>& descents,
                    double least_agreement, std::vector<Looked>& all) {
  constexpr bool kStopped = true;
  std::vector<OwnSight> rejected;  // of the first, which is the lowest
  for (std::size_t i = 0; i < descents.size(); ++i) {
    Looked one{descents[i], {}, {}};
    if (!rounds.look(one, fmt::format("own look {}", i + 1))) return {kStopped};
    const std::vector<OwnSight> sights = sightsOf(one.looks);
    if (agreementOf(sights) < least_agreement) {
      if (rejected.empty()) rejected = sights;
      continue;
    }
    if (!rounds.polish(one)) return {kStopped};
    all.push_back(std::move(one));
  }
  if (all.empty()) return {!kStopped, rejected};
  std::stable_sort(all.begin(), all.end(), [](const Looked& a, const Looked& b) {
    return a.descent.best.cost < b.descent.best.cost;
  });
  Looked& best = all.front();
  const double before = best.descent.best.cost;
  rounds.searchSections();
  if (!rounds.look(best, "own look again") || !rounds.polish(best) || !rounds.settle(best))
    return {kStopped};
  // J of the others is comparable with that of the first round.
  const double change = best.descent.best.cost - before;
  for (std::size_t i = 1; i < all.size(); ++i) all[i].descent.best.cost += change;
  return {};
}

}  // namespace

OwnLookEnd polishWithOwnLooks(FittedSides& sides, const std::vector<heart::View>& views,
                              const HeartFitOptions& options, double least_agreement,
                              const FitStages& stages, FitProgress& progress, FitCost& cost,
                              std::vector<FitDescent>& descents) {
  const std::vector<ExpectedLook> before = sides.looks;
  LookRounds rounds(sides, views, options, stages, progress, cost);
  std::vector<FitDescent> ends = descents;
  FitPlace first = descents.front().best;
  makePossible(cost, first.at);
  OwnLookEnd end{true};
  std::vector<Looked> all;
  if (sides.chooseLook(cost, views, first, progress.next(stages.choice))) {
    addMirrored(cost, stages, progress, ends);
    if (!ends.back().stopped) end = addLooks(rounds, hopefulOf(cost, ends), least_agreement, all);
  }
  const bool done = !end.stopped && end.rejected.empty();
  sides.looks = done ? all.front().looks : before;
  cost = rounds.costOf(done ? all.front().stage : "descents");
  if (!done) return end;
  descents.clear();
  for (Looked& one : all) descents.push_back(std::move(one.descent));
  return end;
}

}  // namespace echocine::fit
