#include "fit/fitted_sides.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/error.h"
#include "core/parallel.h"
#include "echo/persistence.h"
#include "fit/counted_steps.h"
#include "fit/fit_doubts.h"
#include "fit/fit_polish.h"
#include "fit/fit_regions.h"
#include "motion/heart/heart.h"
#include "scene/looks.h"

namespace echocine::fit {

namespace {

bool exists(const std::map<std::string, double>& dials) {
  const heart::Parameters parameters = heart::parametersFrom(dials);
  if (!heart::faultOf(parameters).empty()) return false;
  try {
    const heart::ParametricHeart heart(parameters);
    return true;
  } catch (const SceneError&) {
    return false;
  }
}

// The seed of an own loop of a view.
int seedOf(std::size_t view, int twin) {
  return 71 + static_cast<int>(view) + 100 * twin;
}

OwnDiscrepancies pointersTo(const std::deque<ModelDiscrepancy>& own) {
  OwnDiscrepancies out;
  for (const ModelDiscrepancy& one : own) out.push_back(&one);
  return out;
}

// The persistence of own loops with the same lag in beats; none, that of the look, for loops with
// little: their look was chosen with it.
std::optional<double> ownPersistence(std::optional<double> in_loop, double frames_per_beat) {
  if (in_loop.value_or(0) < kMuchPersistence || !(frames_per_beat > 0)) return std::nullopt;
  const double lag = echo::lagFrames(*in_loop) * kFitFrames / frames_per_beat;
  return lag / (1 + lag);
}

// The beat of own loops is that of the model.
echo::SideOptions beatOf(const ModelLoop& model) {
  echo::SideOptions side;
  side.ed_frame = 0;
  if (model.systole > 0) side.es_frame = model.systole * kFitFrames;
  return side;
}

}  // namespace

FittedSides::FittedSides(const std::vector<FitLoop>& loops,
                         std::vector<std::optional<double>> persistence_, const HeartNodes& hearts,
                         double tilt_deg, const Monitor& monitor)
    : persistence(std::move(persistence_)) {
  for (const FitLoop& one : loops)
    families.push_back(
        std::make_shared<const HeartFamily>(hearts, one.view, monitor, tilt_deg, true));
  looks.resize(loops.size());
}

void FittedSides::compare(const std::vector<FitLoop>& loops, const std::vector<double>& dials) {
  std::deque<ModelDiscrepancy> made;
  for (std::size_t v = 0; v < loops.size(); ++v)
    made.emplace_back(loops[v].loop, loops[v].side,
                      families[v]->at(dials, {}, Focus::left_ventricle));
  discrepancies = std::move(made);
}

OwnHeart FittedSides::ownHeartOf(std::size_t view, const FitCost& cost, heart::View name,
                                 const FitPlace& place) const {
  return {cost.dialsAt(place.at), name, cost.tiltAt(place.at, view), kFitFrames};
}

RenderedBeats FittedSides::ownLoopsOf(std::size_t view, const OwnHeart& heart, Look look,
                                      const RenderedBeats* other) const {
  return heart.beats(
      look, ownPersistence(persistence[view], discrepancies[view].beat().span.frames), other);
}

std::vector<FitSide> FittedSides::refer() const {
  std::vector<FitSide> out;
  for (std::size_t v = 0; v < families.size(); ++v)
    out.push_back({families[v].get(), &discrepancies[v], &looks[v]});
  return out;
}

ModelLoop FittedSides::plainAt(std::size_t view, const FitCost& cost, const FitPlace& place) const {
  return families[view]->at(cost.searchedAt(place.at), cost.tiltAt(place.at, view),
                            Focus::left_ventricle);
}

ModelLoop FittedSides::modelAt(std::size_t view, const FitCost& cost, const FitPlace& place) const {
  ModelLoop model = plainAt(view, cost, place);
  looks[view].applyTo(model);
  return model;
}

bool FittedSides::chooseLook(const FitCost& cost, const std::vector<heart::View>& views,
                             const FitPlace& place, const Monitor& monitor) {
  const std::vector<Look> scanners = scannerLooks();
  // Looks that are farther above the lowest after a view are not rendered in others. Our choice.
  constexpr double kMostAbove = 60;
  constexpr double kDropped = std::numeric_limits<double>::infinity();
  std::vector<double> costs(scanners.size());
  CountedSteps steps(monitor, views.size() * scanners.size());
  for (std::size_t v = 0; v < views.size(); ++v) {
    const ModelLoop plain = plainAt(v, cost, place);
    const FitPose& pose = place.found[v].pose;
    const OwnHeart heart = ownHeartOf(v, cost, views[v], place);
    const auto addCost = [&](std::size_t i, RenderedBeats& beats) {
      const echo::EchoLoop loop = beats.loop(seedOf(v, 2 * kTwins));
      const ModelDiscrepancy own(loop, beatOf(plain), plain);
      ModelLoop model = plain;
      lookIn({&own}, plain, discrepancies[v], pose).applyTo(model);
      costs[i] += viewCostOf(discrepancies[v].at(model, pose).discrepancy);
      steps.done();
    };
    const auto first = static_cast<std::size_t>(
        std::find_if(costs.begin(), costs.end(), [](double c) { return c != kDropped; }) -
        costs.begin());
    if (!steps.next()) return false;
    RenderedBeats shared = ownLoopsOf(v, heart, scanners[first]);
    addCost(first, shared);
    parallelBlocks(scanners.size(), 1, [&](std::size_t i, std::size_t) {
      if (i == first || !steps.next()) return;
      if (costs[i] == kDropped) return steps.done();
      RenderedBeats beats = ownLoopsOf(v, heart, scanners[i], &shared);
      addCost(i, beats);
    });
    if (steps.stopped()) return false;
    const double lowest = *std::min_element(costs.begin(), costs.end());
    for (double& one : costs)
      if (one > lowest + kMostAbove) one = kDropped;
  }
  const auto lowest = std::min_element(costs.begin(), costs.end());
  rendered_as = scanners[static_cast<std::size_t>(lowest - costs.begin())];
  return true;
}

ExpectedSlope FittedSides::slopeOf(std::size_t view, const OwnDiscrepancies& own,
                                   const FitCost& cost, const FitPlace& place) const {
  std::vector<std::array<double, 3>> places;
  const std::vector<std::size_t> unknowns = cost.unknownsOf(view);
  for (const std::size_t u : unknowns) {
    const auto [low, high] = cost.besideIn(u, place.at);
    places.push_back({low[u], place.at[u], high[u]});
  }
  return slopeIn(own, places, [&](const std::vector<double>& values) {
    FitPlace at;
    at.at = place.at;
    for (std::size_t i = 0; i < unknowns.size(); ++i) at.at[unknowns[i]] = values[i];
    return plainAt(view, cost, at);
  });
}

bool FittedSides::expectOwnLook(const FitCost& cost, const std::vector<heart::View>& views,
                                const FitPlace& place, const Monitor& monitor, int round) {
  std::vector<ExpectedLook> found(views.size());
  CountedSteps steps(monitor, views.size() * kTwins);
  parallelBlocks(views.size(), 1, [&](std::size_t v, std::size_t) {
    const ModelLoop plain = plainAt(v, cost, place);
    std::deque<ModelDiscrepancy> own;
    RenderedBeats rendered = ownLoopsOf(v, ownHeartOf(v, cost, views[v], place), rendered_as);
    for (int twin = 0; twin < kTwins; ++twin) {
      if (!steps.next()) return;
      own.emplace_back(rendered.loop(seedOf(v, (1 + round) * kTwins + twin)), beatOf(plain), plain);
      steps.done();
    }
    found[v] = lookIn(pointersTo(own), plain, discrepancies[v], place.found[v].pose);
    found[v].slope = slopeOf(v, pointersTo(own), cost, place);
    found[v].slope.scaleTo(found[v].sight()->both());
  });
  if (steps.stopped()) return false;
  looks = std::move(found);
  return true;
}

std::optional<OwnFit> fitOwnLoops(const FittedSides& sides, const FitCost& cost,
                                  const std::vector<heart::View>& views, const FitPlace& best,
                                  double tilt_deg, const Monitor& monitor,
                                  const std::shared_ptr<FitJournal>& journal) {
  FittedSides own;
  own.families = sides.families;
  own.looks = sides.looks;
  OwnFit out;
  std::vector<std::vector<echo::EchoLoop>> loops;
  std::vector<std::deque<ModelDiscrepancy>> others;  // than the first loop
  for (std::size_t v = 0; v < views.size(); ++v) {
    RenderedBeats rendered =
        sides.ownLoopsOf(v, sides.ownHeartOf(v, cost, views[v], best), sides.rendered_as);
    const ModelLoop model = own.modelAt(v, cost, best);
    loops.emplace_back();
    others.emplace_back();
    for (int twin = 0; twin < kTwins; ++twin) {
      if (!monitor.keep_going()) return std::nullopt;
      loops[v].push_back(rendered.loop(seedOf(v, twin)));
      (twin == 0 ? own.discrepancies : others[v])
          .emplace_back(loops[v].back(), beatOf(model), model);
    }
  }
  for (std::size_t v = 0; v < views.size(); ++v) {
    std::optional<OwnSight> sight = own.looks[v].sight();
    if (!sight) {  // a plain fit has not measured it
      OwnDiscrepancies all = pointersTo(others[v]);
      all.insert(all.begin(), &own.discrepancies[v]);
      sight = lookIn(all, own.plainAt(v, cost, best), sides.discrepancies[v], best.found[v].pose)
                  .sight();
    }
    out.sight.push_back(*sight);
  }
  // Edges are expected at the same distances as in the real loops, so that maps are comparable:
  // regions assume that a real loop shows all of the offsets of own loops.
  for (std::size_t v = 0; v < views.size(); ++v) {
    ExpectedLook& look = own.looks[v];
    if (look.greys.empty()) continue;
    ModelLoop model = own.plainAt(v, cost, best);
    look.edges.applyTo(model);
    look.greys.scaleTo(model, own.discrepancies[v].map(model, FitPose{}));
  }
  const FitCost again(own.refer(), cost.fixed(), tilt_deg, {journal, "own loops"});
  // By the same search as in the real loops, without the starts.
  FitDescent found = descendFit(again, {best.at, {}, 0}, monitor);
  const bool looked = std::none_of(own.looks.begin(), own.looks.end(),
                                   [](const ExpectedLook& look) { return look.greys.empty(); });
  if (looked && !found.stopped) found = polishFit(again, std::move(found), monitor);
  if (found.stopped) return std::nullopt;
  for (std::size_t i = 0; i < again.dials(); ++i)
    if (const FitUnknown& u = again.unknowns()[i]; !u.held)
      out.error[u.name] = found.best.at[i] - best.at[i];
  // With the dials that the fit finds: maps of the real loops have the same bias.
  for (std::size_t v = 0; v < views.size(); ++v) {
    const ModelLoop model = own.modelAt(v, cost, found.best);
    const FitPose pose = own.discrepancies[v].refine(model, {FitPose{}}).pose;
    out.report.push_back(fitReport(model, own.discrepancies[v], loops[v].front(), pose));
    out.twins.push_back({out.report.back().map});
    for (const ModelDiscrepancy& other : others[v])
      out.twins.back().push_back(other.map(model, other.refine(model, {FitPose{}}).pose));
  }
  return out;
}

bool makePossible(const FitCost& cost, std::vector<double>& at) {
  constexpr int kMostMoves = 16;  // to a hundredth of the distance
  constexpr double kPart = 0.25;
  int moves = 0;
  for (; moves < kMostMoves && !exists(cost.dialsAt(at)); ++moves)
    for (std::size_t i = 0; i < cost.dials(); ++i) {
      const FitUnknown& u = cost.unknowns()[i];
      if (!u.held) at[i] += kPart * (0.5 * (u.low + u.high) - at[i]);
    }
  return moves > 0;
}

}  // namespace echocine::fit
