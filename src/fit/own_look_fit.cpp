#include "fit/own_look_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "fit/fit_polish.h"

namespace echocine::fit {

namespace {

// A descent with the look that it ended with.
struct Looked {
  FitDescent descent;
  std::vector<ExpectedLook> looks;
  std::string stage;
};

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
    return {sides_.refer(), plain_.fixed(), options_.tilt_deg, {options_.journal, stage}};
  }

  // Measures the look of the descent's heart and polishes the descent with it. False if stopped.
  bool add(Looked& one, std::string stage) {
    FitDescent& descent = one.descent;
    makePossible(plain_, descent.best.at);
    if (!sides_.expectOwnLook(plain_, views_, descent.best, progress_.next(stages_.look)))
      return false;
    one.stage = std::move(stage);
    const FitCost cost = costOf(one.stage);
    descent.best = cost.at(descent.best.at, descent.best.found);
    descent = polishFit(cost, std::move(descent), progress_.next(stages_.polish));
    one.looks = sides_.looks;
    return !descent.stopped;
  }

 private:
  FittedSides& sides_;
  const std::vector<heart::View>& views_;
  const HeartFitOptions& options_;
  const FitStages& stages_;
  FitProgress& progress_;
  const FitCost& plain_;  // only for its unknowns: its sides change
};

// Those that differ and may still become the best.
std::vector<FitDescent> hopefulOf(const FitCost& cost, const std::vector<FitDescent>& descents) {
  constexpr double kMostAbove = 100;   // of J; our choice
  constexpr double kOneMinimum = 0.5;  // steps of each unknown; our choice
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
  if (!rounds.add(all.front(), "own look again")) return false;
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
  std::vector<Looked> all;
  const bool done = addLooks(rounds, hopefulOf(cost, descents), all);
  sides.looks = done ? all.front().looks : before;
  cost = rounds.costOf(done ? all.front().stage : "descents");
  if (!done) return false;
  descents.clear();
  for (Looked& one : all) descents.push_back(std::move(one.descent));
  return true;
}

}  // namespace echocine::fit
