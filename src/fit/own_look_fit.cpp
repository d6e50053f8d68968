#include "fit/own_look_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

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

// Mean of q c over the views.
double meanShown(const std::vector<ExpectedLook>& looks) {
  double sum = 0;
  for (const ExpectedLook& look : looks) sum += look.sight().value_or(OwnSight{}).both();
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

  // Measures the look of the descent's heart and polishes the descent with it. False if stopped.
  bool add(Looked& one, std::string stage) {
    FitDescent& descent = one.descent;
    one.stage = std::move(stage);
    if (!measure(one, 0)) return false;
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

bool addLooks(LookRounds& rounds, const std::vector<FitDescent>& descents,
              std::vector<Looked>& all) {
  for (const FitDescent& descent : descents) {
    all.push_back({descent, {}, {}});
    if (!rounds.add(all.back(), fmt::format("own look {}", all.size()))) return false;
  }
  std::stable_sort(all.begin(), all.end(), [](const Looked& a, const Looked& b) {
    return a.descent.best.cost < b.descent.best.cost;
  });
  const double before = all.front().descent.best.cost;
  rounds.searchSections();
  if (!rounds.add(all.front(), "own look again") || !rounds.settle(all.front())) return false;
  // J of the others is comparable with that of the first round.
  const double change = all.front().descent.best.cost - before;
  for (std::size_t i = 1; i < all.size(); ++i) all[i].descent.best.cost += change;
  return true;
}

}  // namespace

bool polishWithOwnLooks(FittedSides& sides, const std::vector<heart::View>& views,
                        const HeartFitOptions& options, const FitStages& stages,
                        FitProgress& progress, FitCost& cost, std::vector<FitDescent>& descents) {
  const std::vector<ExpectedLook> before = sides.looks;
  LookRounds rounds(sides, views, options, stages, progress, cost);
  std::vector<FitDescent> ends = descents;
  FitPlace first = descents.front().best;
  makePossible(cost, first.at);
  bool done = sides.chooseLook(cost, views, first, progress.next(stages.choice));
  if (done) addMirrored(cost, stages, progress, ends);
  std::vector<Looked> all;
  done = done && !ends.back().stopped && addLooks(rounds, hopefulOf(cost, ends), all);
  sides.looks = done ? all.front().looks : before;
  cost = rounds.costOf(done ? all.front().stage : "descents");
  if (!done) return false;
  descents.clear();
  for (Looked& one : all) descents.push_back(std::move(one.descent));
  return true;
}

}  // namespace echocine::fit
