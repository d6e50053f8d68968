#include "fit/heart_fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <memory>

#include "core/error.h"
#include "core/units.h"
#include "echo/beat_length.h"
#include "fit/cpu_seconds.h"
#include "fit/fit_descent.h"
#include "fit/fit_interval.h"
#include "fit/own_loop.h"

namespace echocine::fit {

namespace {

std::vector<DialRange> rangesOf(const HeartFitOptions& options) {
  std::vector<DialRange> out;
  for (const DialRange& range : searchedRanges()) {
    const auto& keys = options.searched;
    if (std::find(keys.begin(), keys.end(), range.key) != keys.end() &&
        !options.dials.contains(range.key))
      out.push_back(range);
  }
  if (out.empty())
    throw SceneError(
        "searched: names no dial, accepted: one of ef, edv, "
        "wall-thickness, sphericity, mapse that is not fixed");
  return out;
}

void checkLoops(const std::vector<FitLoop>& loops, const HeartFitOptions& options) {
  if (loops.empty() || loops.size() > kMostLoops)
    throw SceneError(fmt::format("fit: has {} loops, accepted: 1 to {}", loops.size(), kMostLoops));
  for (std::size_t i = 0; i < loops.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (loops[i].view == loops[j].view)
        throw SceneError(fmt::format("fit: {} is given twice", keyOf(loops[i].view)));
  if (options.starts < 1 || options.descents < 1)
    throw SceneError("fit: starts and descents must be 1 or more");
  checkTilt(options.tilt_deg);
}

// The mean over loops that have one, within the models' range.
std::optional<double> rateOf(const std::vector<FitLoop>& loops, HeartFit& fit) {
  std::vector<double> rates;
  for (const FitLoop& one : loops) {
    const echo::BeatLength length = echo::beatOf(one.loop);
    const double hz = one.loop.video.rate.hz;
    if (length.frames > 0 && hz > 0) rates.push_back(60 * hz / length.frames);
  }
  if (rates.empty()) return std::nullopt;
  const auto [low, high] = std::minmax_element(rates.begin(), rates.end());
  constexpr double kMostApart = 1.15;
  if (*high > kMostApart * *low)
    fit.hints.push_back(fmt::format(
        "heart rates of the loops are {:.0f} to {:.0f} bpm: are they of one heart?", *low, *high));
  double sum = 0;
  for (const double rate : rates) sum += rate / static_cast<double>(rates.size());
  constexpr double kLeast_bpm = 40, kMost_bpm = 150;
  return std::clamp(sum, kLeast_bpm, kMost_bpm);
}

// Families and comparisons of all views.
struct FittedSides {
  std::vector<std::shared_ptr<const HeartFamily>> families;
  std::deque<ModelDiscrepancy> discrepancies;

  FittedSides() = default;
  FittedSides(const std::vector<FitLoop>& loops, const HeartNodes& hearts, double tilt_deg,
              const Monitor& monitor) {
    for (const FitLoop& one : loops)
      families.push_back(std::make_shared<const HeartFamily>(hearts, one.view, monitor, tilt_deg));
  }
  // With models of these dials, which find the beat.
  void compare(const std::vector<FitLoop>& loops, const std::vector<double>& dials) {
    discrepancies.clear();
    for (std::size_t v = 0; v < loops.size(); ++v)
      discrepancies.emplace_back(loops[v].loop, loops[v].side, families[v]->at(dials));
  }
  std::vector<FitSide> refer() const {
    std::vector<FitSide> out;
    for (std::size_t v = 0; v < families.size(); ++v)
      out.push_back({families[v].get(), &discrepancies[v]});
    return out;
  }
};

// The healthy mean, the mean of those with an infarct, then draws; moved into the ranges. Planes
// are those of the view.
std::vector<std::vector<double>> startsOf(const FitCost& cost, int count) {
  constexpr std::uint64_t kSeed = 34;
  std::vector<std::vector<double>> out;
  for (int n = 0; n < count; ++n) {
    const auto number = static_cast<std::size_t>(n);
    const PriorDials dials =
        HeartPrior::dialsOf(number < heartGroups().size() ? heartGroups()[number].mean
                                                          : cost.prior().draw(kSeed, number));
    std::vector<double> at(cost.unknowns().size(), 0);
    for (std::size_t i = 0; i < cost.dials(); ++i) {
      const FitUnknown& u = cost.unknowns()[i];
      if (const auto p = priorDialOf(u.name))
        at[i] = std::clamp(dials[*p], u.low + u.step, u.high - u.step);
    }
    out.push_back(std::move(at));
  }
  return out;
}

// One line of progress for starts and descents: a round of a descent takes as long as several
// starts.
struct FitProgress {
  const Monitor& monitor;
  std::size_t starts, descents;
  static constexpr std::size_t kStartsPerRound = 8;

  void tell(std::size_t starts_done, std::size_t rounds_done) const {
    const std::size_t per = kStartsPerRound;
    monitor.tell({Task::settings, starts_done + per * rounds_done,
                  starts + per * (descents + 1) * static_cast<std::size_t>(kMostFitRounds)});
  }
  // The monitor of a descent after `before` others.
  Monitor ofDescent(std::size_t before) const {
    Monitor one = monitor;
    one.tell = [this, before](const Progress& p) {
      tell(starts, before * static_cast<std::size_t>(kMostFitRounds) + p.done);
    };
    return one;
  }
  Monitor ofLast() const { return ofDescent(descents); }
};

std::vector<FitPlace> startPlaces(const FitCost& cost, const FitProgress& progress, HeartFit& fit) {
  std::vector<FitPlace> places;
  try {
    for (const std::vector<double>& at : startsOf(cost, static_cast<int>(progress.starts))) {
      if (!progress.monitor.keep_going()) throw JobError("stopped while a heart was fitted");
      places.push_back(cost.at(at, {}));
      progress.tell(places.size(), 0);
    }
  } catch (const JobError&) {
    if (places.empty() || progress.monitor.keep_going()) throw;
    fit.stopped = true;
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const FitPlace& a, const FitPlace& b) { return a.cost < b.cost; });
  return places;
}

// Precondition: not stopped.
std::vector<FitDescent> descentsFrom(const FitCost& cost, const std::vector<FitPlace>& starts,
                                     const FitProgress& progress, HeartFit& fit) {
  std::vector<FitDescent> out;
  for (std::size_t d = 0; d < std::min(progress.descents, starts.size()) && !fit.stopped; ++d) {
    out.push_back(descendFit(cost, starts[d], progress.ofDescent(d)));
    fit.stopped = out.back().stopped;
  }
  std::stable_sort(out.begin(), out.end(), [](const FitDescent& a, const FitDescent& b) {
    return a.best.cost < b.best.cost;
  });
  return out;
}

void addViews(const std::vector<FitLoop>& loops, const FittedSides& sides, const FitCost& cost,
              const FitPlace& best, HeartFit& fit) {
  for (std::size_t v = 0; v < loops.size(); ++v)
    fit.views.push_back({loops[v].view, sides.discrepancies[v].beat(), cost.tiltAt(best.at, v),
                         best.found[v], loops[v].loop.metres_per_pixel.has_value()});
}

// Error of a fit of the best heart's own loops, by dial: found minus rendered.
std::vector<double> ownError(const std::vector<FitLoop>& loops, const FittedSides& sides,
                             const FitCost& cost, const FitPlace& best, double tilt_deg,
                             const HeartFit& fit, const Monitor& monitor) {
  constexpr int kSeed = 71;
  FittedSides own;
  own.families = sides.families;
  for (std::size_t v = 0; v < loops.size(); ++v) {
    const PlaneTilt tilt = cost.tiltAt(best.at, v);
    const echo::EchoLoop loop = ownLoop(cost.dialsAt(best.at), loops[v].view, tilt, kFitFrames,
                                        kSeed + static_cast<int>(v));
    echo::SideOptions side;
    side.ed_frame = 0;
    own.discrepancies.emplace_back(loop, side, own.families[v]->at(cost.searchedAt(best.at), tilt));
  }
  const FitCost again(own.refer(), fit.dials, tilt_deg);
  const FitDescent found = descendFit(again, {best.at, {}, 0}, monitor);
  if (found.stopped) return {};
  std::vector<double> error;
  for (std::size_t i = 0; i < cost.dials(); ++i) error.push_back(found.best.at[i] - best.at[i]);
  return error;
}

// Subtracts the error of the comparison itself from the hearts that were found.
void correct(const FitCost& cost, const std::vector<double>& error,
             std::vector<FitDescent>& descents, HeartFit& fit) {
  for (std::size_t i = 0; i < error.size(); ++i) {
    const FitUnknown& u = cost.unknowns()[i];
    fit.own_error[u.name] = error[i];
    for (FitDescent& descent : descents)
      descent.best.at[i] = std::clamp(descent.best.at[i] - error[i], u.low, u.high);
  }
}

}  // namespace

// Adult hearts, failing to vigorous. Our choice.
const std::vector<DialRange>& searchedRanges() {
  static const std::vector<DialRange> kRanges{{"ef", 0.15, 0.75},
                                              {"edv", 50, 280},
                                              {"wall-thickness", 5, 15},
                                              {"sphericity", 0.46, 0.78},
                                              {"mapse", 3, 20}};
  return kRanges;
}

HeartFit fitHeart(const std::vector<FitLoop>& loops, const HeartFitOptions& options,
                  const Monitor& monitor) {
  checkLoops(loops, options);
  const double since = cpuSeconds();
  HeartFit fit;
  fit.dials = options.dials;
  if (const auto rate = rateOf(loops, fit); rate && !fit.dials.contains("hr"))
    fit.dials["hr"] = *rate;
  const HeartNodes hearts(fit.dials, HeartDesign::polynomial(rangesOf(options)), kFitFrames,
                          monitor);
  FittedSides sides(loops, hearts, options.tilt_deg, monitor);
  std::vector<double> middle;
  for (const DialRange& range : hearts.ranges()) middle.push_back(0.5 * (range.low + range.high));
  sides.compare(loops, middle);
  FitCost cost(sides.refer(), fit.dials, options.tilt_deg);
  const FitProgress progress{monitor, static_cast<std::size_t>(options.starts),
                             static_cast<std::size_t>(options.descents)};
  const std::vector<FitPlace> starts = startPlaces(cost, progress, fit);
  std::vector<FitDescent> descents{{starts.front(), {}, true}};
  if (!fit.stopped) {
    // The best start finds the beat anew.
    sides.compare(loops, cost.searchedAt(starts.front().at));
    cost = FitCost(sides.refer(), fit.dials, options.tilt_deg);
    descents = descentsFrom(cost, starts, progress, fit);
  }
  addViews(loops, sides, cost, descents.front().best, fit);
  if (!fit.stopped && options.own_loops) {
    const std::vector<double> error = ownError(loops, sides, cost, descents.front().best,
                                               options.tilt_deg, fit, progress.ofLast());
    fit.stopped = error.empty();
    correct(cost, error, descents, fit);
  }
  concludeFit(cost, descents, fit);
  fit.cpu_ms = 1e3 * (cpuSeconds() - since);
  return fit;
}

}  // namespace echocine::fit
