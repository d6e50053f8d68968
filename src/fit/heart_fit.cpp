#include "fit/heart_fit.h"

#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/stop.h"
#include "core/units.h"
#include "fit/cpu_seconds.h"
#include "fit/fit_descent.h"
#include "fit/fit_input.h"
#include "fit/fit_interval.h"
#include "fit/fit_progress.h"
#include "fit/fit_resamples.h"
#include "fit/fit_stages.h"
#include "fit/fit_starts.h"
#include "fit/fitted_sides.h"
#include "fit/own_look_fit.h"
#include "fit/searched_dials.h"

namespace echocine::fit {

namespace {

std::vector<DialRange> rangesOf(const HeartFitOptions& options, std::size_t views) {
  const auto keys = options.searched.value_or(dialsSearchedIn(views, options.ownLook(views)));
  if (options.searched) checkSearched(*options.searched);
  std::vector<DialRange> out;
  for (const SearchedDial& dial : searchedDials())
    if (std::find(keys.begin(), keys.end(), dial.range.key) != keys.end() &&
        !isFixed(dial.range.key, options.dials))
      out.push_back(dial.range);
  if (out.empty())
    throw SceneError(fmt::format("searched: names no dial, accepted: one of {} that is not fixed",
                                 searchedKeys()));
  return out;
}

std::vector<heart::View> viewsOf(const std::vector<FitLoop>& loops) {
  std::vector<heart::View> views;
  for (const FitLoop& one : loops) views.push_back(one.view);
  return views;
}

void checkInput(const std::vector<FitLoop>& loops, const HeartFitOptions& options) {
  checkFitViews(viewsOf(loops));
  checkFitOptions(options);
  for (const FitLoop& one : loops) checkMoves(one);
}

std::vector<FitDescent> descentsFrom(const FitCost& cost, const std::vector<FitPlace>& starts,
                                     const FitStages& stages, FitProgress& progress) {
  std::vector<FitDescent> out;
  for (std::size_t d = 0; d < std::min(stages.descents, starts.size()); ++d) {
    out.push_back(descendFit(cost, starts[d], progress.next(stages.descent)));
    if (out.back().stopped) break;
  }
  std::stable_sort(out.begin(), out.end(), [](const FitDescent& a, const FitDescent& b) {
    return a.best.cost < b.best.cost;
  });
  return out;
}

bool anyStopped(const std::vector<FitDescent>& descents) {
  return std::any_of(descents.begin(), descents.end(),
                     [](const FitDescent& descent) { return descent.stopped; });
}

// Adds the views with the best heart in each.
void addViews(const std::vector<FitLoop>& loops, const FittedSides& sides, const FitCost& cost,
              const FitPlace& best, HeartFit& fit) {
  for (std::size_t v = 0; v < loops.size(); ++v) {
    const echo::EchoLoop& loop = loops[v].loop;
    const ModelDiscrepancy& discrepancy = sides.discrepancies[v];
    const FitPose& pose = best.found[v].pose;
    ViewFitted view;
    view.view = loops[v].view;
    view.beat = discrepancy.beat();
    view.tilt = cost.tiltAt(best.at, v);
    view.found = best.found[v];
    view.own_sight = sides.looks[v].sight();
    view.scaled = loop.metres_per_pixel.has_value();
    view.persistence = sides.persistence[v];
    view.report = fitReport(sides.modelAt(v, cost, best), discrepancy, loop, pose);
    fit.views.push_back(std::move(view));
  }
}

void addRejected(const std::vector<OwnSight>& rejected, HeartFit& fit) {
  for (std::size_t v = 0; v < rejected.size(); ++v) fit.views[v].own_sight = rejected[v];
  fit.assumed.push_back(
      fmt::format("the loops do not look like the heart's own rendered loops (agreement {:.2f}, "
                  "below {}): the look of these is not expected",
                  agreementOf(rejected), kLeastAgreement));
}

// Without the expected look, which is that of the loop itself.
void addControls(const std::vector<FitLoop>& loops, const FittedSides& sides, const FitCost& cost,
                 const FitPlace& best, HeartFit& fit) {
  for (std::size_t v = 0; v < loops.size(); ++v) {
    fit.views[v].controls = controlFits(loops[v].loop, fit.views[v].beat.span,
                                        sides.plainAt(v, cost, best), fit.views[v].found.pose);
  }
}

// Without a heart of these dials, or after a stop, nothing is known of other views.
void addOtherViews(const FittedSides& sides, const FitCost& cost, const FitPlace& best,
                   const Monitor& monitor, HeartFit& fit) {
  for (std::size_t v = 0; v < fit.views.size(); ++v) {
    ViewFitted& view = fit.views[v];
    const ModelLoop own = sides.families[v]->at(cost.searchedAt(best.at), view.tilt);
    try {
      view.better = betterView(cost.dialsAt(best.at), view.view, sides.discrepancies[v], own,
                               view.found.pose, monitor);
    } catch (const SceneError&) {
      return;
    }
  }
}

// Work on a fit that a stop ends, and that then stays as it is.
void unlessStopped(const Monitor& monitor, HeartFit& fit, const std::function<void()>& work) {
  if (fit.stopped) return;
  try {
    work();
  } catch (const JobError&) {
    if (monitor.keep_going()) throw;
    fit.stopped = true;
  }
}

HeartCache cacheOf(const HeartFitOptions& options, const Monitor& monitor) {
  if (options.heart_cache.empty()) return {};
  return HeartCache(options.heart_cache, kMostCacheBytes, monitor.warn);
}

std::vector<double> middleOf(const std::vector<DialRange>& ranges) {
  std::vector<double> middle;
  for (const DialRange& range : ranges) middle.push_back(0.5 * (range.low + range.high));
  return middle;
}

void keepPossible(const FitCost& cost, FitDescent& best, HeartFit& fit) {
  if (!makePossible(cost, best.best.at)) return;
  best.best = cost.at(best.best.at, best.best.found);
  fit.hints.emplace_back(
      "no heart has the dials of the best fit together: those of the nearest one are reported");
}

// Fits the found heart's own rendered loops: regions, and the error of such a fit.
void compareWithOwnLoops(const FittedSides& sides, const FitCost& cost,
                         const HeartFitOptions& options, const Monitor& monitor,
                         const FitPlace& best, HeartFit& fit) {
  std::vector<heart::View> views;
  for (const ViewFitted& view : fit.views) views.push_back(view.view);
  auto own = fitOwnLoops(sides, cost, views, best, options.tilt_deg, monitor, options.journal);
  fit.stopped = !own;
  if (!own) return;
  for (std::size_t v = 0; v < views.size(); ++v) fit.views[v].own_sight = own->sight[v];
  const RegionFloor floor = fit.own_look ? floorWithOwnLook(*agreementOf(fit.views)) : kFittedDials;
  for (std::size_t v = 0; v < views.size(); ++v) {
    fit.views[v].regions = regionFindings(fit.views[v].report, own->twins[v], floor);
    fit.views[v].own = std::move(own->report[v]);
  }
  fit.own_error = std::move(own->error);
}

// Intervals that are no narrower than the spread over parts of the loops.
void resample(const FittedSides& sides, const FitCost& cost, const HeartFitOptions& options,
              const Monitor& monitor, FitDescent& best, HeartFit& fit) {
  const std::vector<double> sds =
      resampledSds(sides.refer(), cost, best.best, options.resamples, options.journal, monitor);
  fit.stopped = sds.empty();
  for (std::size_t i = 0; i < sds.size(); ++i) fit.resampled_sd[cost.unknowns()[i].name] = sds[i];
  widenBy(sds, best.covariance);
}

// A fit, or none if it has to be repeated with the dials of plain fits: the loops do not look like
// own loops.
struct Attempt {
  std::optional<HeartFit> fit;
  // Without a fit: by view, and units of progress.
  std::vector<OwnSight> rejected{};
  double units = 0;
};

// `rejected`: of an earlier attempt. Precondition: options.own_look has a value.
Attempt attemptFit(const std::vector<FitLoop>& loops,
                   const std::vector<std::optional<double>>& persistence,
                   const HeartFitOptions& options, double least_agreement,
                   std::vector<OwnSight> rejected, const Monitor& monitor) {
  HeartFit fit;
  fit.dials = options.dials;
  for (const FitLoop& one : loops)
    for (std::string& note : notesOf(one)) fit.hints.push_back(std::move(note));
  if (const auto rate = rateOf(loops, fit.hints); rate && !fit.dials.contains("hr"))
    fit.dials["hr"] = *rate;
  fit.fixed = fit.dials;
  fit.tilt_deg = options.tilt_deg;
  const HeartDesign design = HeartDesign::polynomial(rangesOf(options, loops.size()));
  const FitStages stages(loops.size(), design, options);
  FitProgress progress(monitor, stages.all());
  FittedSides sides = [&] {
    const HeartNodes hearts(fit.dials, design, kFitFrames, progress.next(stages.hearts),
                            cacheOf(options, monitor));
    return FittedSides(loops, persistence, hearts, options.tilt_deg,
                       progress.next(stages.families));
  }();
  ::malloc_trim(0);  // the computed hearts took as much memory as a family
  sides.compare(loops, middleOf(design.ranges()));
  FitCost cost(sides.refer(), fit.dials, options.tilt_deg, {options.journal, "starts"});
  const FitStarts starts = startPlaces(cost, options.starts, progress.next(stages.starts));
  fit.stopped = starts.stopped;
  std::vector<FitDescent> descents{{starts.places.front(), {}, true}};
  unlessStopped(monitor, fit, [&] {
    // The best start finds the beat anew.
    sides.compare(loops, cost.searchedAt(starts.places.front().at));
    cost = FitCost(sides.refer(), fit.dials, options.tilt_deg, {options.journal, "descents"});
    if (!options.ownLook(loops.size())) cost.searchSections();
    descents = descentsFrom(cost, starts.places, stages, progress);
    fit.stopped = anyStopped(descents);
  });
  unlessStopped(monitor, fit, [&] {
    if (!options.ownLook(loops.size())) return;
    OwnLookEnd end = polishWithOwnLooks(sides, viewsOf(loops), options, least_agreement, stages,
                                        progress, cost, descents);
    fit.stopped = end.stopped;
    fit.own_look = !end.stopped && end.rejected.empty();
    fit.rendered_as = sides.rendered_as;
    rejected = std::move(end.rejected);
  });
  if (stages.unknowns < stages.all_unknowns && !rejected.empty())
    return {{}, rejected, progress.used()};
  unstoppable([&] { keepPossible(cost, descents.front(), fit); });
  const FitPlace best = descents.front().best;
  unstoppable([&] {
    addViews(loops, sides, cost, best, fit);
    if (!rejected.empty()) addRejected(rejected, fit);
  });
  unlessStopped(monitor, fit, [&] { addControls(loops, sides, cost, best, fit); });
  unlessStopped(monitor, fit, [&] {
    if (options.other_views) addOtherViews(sides, cost, best, monitor, fit);
  });
  unlessStopped(monitor, fit, [&] {
    if (options.resamples > 0)
      resample(sides, cost, options, progress.next(stages.resamples), descents.front(), fit);
  });
  unlessStopped(monitor, fit, [&] {
    if (options.own_loops)
      compareWithOwnLoops(sides, cost, options, progress.next(stages.own), descents.front().best,
                          fit);
  });
  concludeFit(cost, descents, fit);
  if (!fit.stopped) progress.finish();
  return {std::move(fit)};
}

}  // namespace

void checkFitOptions(const HeartFitOptions& options) {
  if (options.starts < 1 || options.descents < 1)
    throw SceneError("fit: starts and descents must be 1 or more");
  if (options.settling_steps < 0) throw SceneError("fit: settling_steps must be 0 or more");
  checkTilt(options.tilt_deg);
  checkResamples(options.resamples);
}

void checkFitViews(const std::vector<heart::View>& views) {
  if (views.empty() || views.size() > kMostLoops)
    throw SceneError(fmt::format("fit: has {} loops, accepted: 1 to {}", views.size(), kMostLoops));
  for (std::size_t i = 0; i < views.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (views[i] == views[j])
        throw SceneError(fmt::format("fit: {} is given twice", keyOf(views[i])));
}

HeartFit fitHeart(const std::vector<FitLoop>& loops, const HeartFitOptions& given,
                  const Monitor& monitor) {
  checkInput(loops, given);
  const double since = cpuSeconds();
  const std::vector<std::optional<double>> persistence = persistencesOf(loops);
  HeartFitOptions options = given;
  options.own_look = ownLookFor(persistence, given);
  const double least = leastAgreement(persistence, given);
  Attempt attempt = attemptFit(loops, persistence, options, least, {}, monitor);
  if (!attempt.fit) {
    options.own_look = false;
    const double units = attempt.units;
    attempt = attemptFit(loops, persistence, options, least, std::move(attempt.rejected),
                         monitorAfter(units, monitor));
  }
  attempt.fit->cpu_ms = 1e3 * (cpuSeconds() - since);
  return std::move(*attempt.fit);
}

}  // namespace echocine::fit
