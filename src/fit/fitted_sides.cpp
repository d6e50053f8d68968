#include "fit/fitted_sides.h"

#include <algorithm>

#include "core/error.h"
#include "fit/own_loop.h"
#include "motion/heart/heart.h"

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

}  // namespace

FittedSides::FittedSides(const std::vector<FitLoop>& loops, const HeartNodes& hearts,
                         double tilt_deg, const Monitor& monitor) {
  for (const FitLoop& one : loops)
    families.push_back(std::make_shared<const HeartFamily>(hearts, one.view, monitor, tilt_deg));
}

void FittedSides::compare(const std::vector<FitLoop>& loops, const std::vector<double>& dials) {
  std::deque<ModelDiscrepancy> made;
  for (std::size_t v = 0; v < loops.size(); ++v)
    made.emplace_back(loops[v].loop, loops[v].side, families[v]->at(dials));
  discrepancies = std::move(made);
}

std::vector<FitSide> FittedSides::refer() const {
  std::vector<FitSide> out;
  for (std::size_t v = 0; v < families.size(); ++v)
    out.push_back({families[v].get(), &discrepancies[v]});
  return out;
}

namespace {

// Minus C g: where the gradient of J without the prior moves the unknowns. In their units.
std::vector<double> ownStep(const FitCost& cost, const FitDescent& best,
                            const std::vector<Quadratic>& views) {
  constexpr double kMostOwnSteps = 2;
  const std::size_t n = best.best.at.size();
  std::vector<double> out(n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    for (const Quadratic& view : views)
      for (std::size_t j = 0; j < n; ++j)
        out[i] -= best.covariance[i * n + j] * view.gradient[j] / cost.unknowns()[j].step;
    const double most = kMostOwnSteps * cost.unknowns()[i].step;
    out[i] = std::clamp(out[i], -most, most);
  }
  return out;
}

// Renders the loops of the best heart and compares it with them.
FittedSides ownSides(const FittedSides& sides, const FitCost& cost,
                     const std::vector<heart::View>& views, const FitPlace& best, int seed,
                     FitPlace& place, std::vector<FitReport>* reports) {
  FittedSides own;
  own.families = sides.families;
  place.at = best.at;
  for (std::size_t v = 0; v < views.size(); ++v) {
    const PlaneTilt tilt = cost.tiltAt(best.at, v);
    const echo::EchoLoop loop =
        ownLoop(cost.dialsAt(best.at), views[v], tilt, kFitFrames, seed + static_cast<int>(v));
    echo::SideOptions side;
    side.ed_frame = 0;
    const ModelLoop model = own.families[v]->at(cost.searchedAt(best.at), tilt);
    own.discrepancies.emplace_back(loop, side, model);
    const ModelDiscrepancy& discrepancy = own.discrepancies.back();
    place.found.push_back(discrepancy.refine(model, {FitPose{}}));
    if (reports != nullptr)
      reports->push_back(fitReport(model, discrepancy, loop, place.found.back().pose));
  }
  return own;
}

}  // namespace

std::optional<OwnFit> fitOwnLoops(const FittedSides& sides, const FitCost& cost,
                                  const std::vector<heart::View>& views, const FitDescent& best,
                                  double tilt_deg, const Monitor& monitor) {
  constexpr int kSeed = 71;
  OwnFit out;
  out.error.assign(cost.dials(), 0);
  const std::size_t n = cost.unknowns().size();
  try {
    for (int draw = 0; draw < kOwnDraws; ++draw) {
      if (!monitor.keep_going()) return std::nullopt;
      FitPlace place;
      const FittedSides own =
          ownSides(sides, cost, views, best.best, kSeed + static_cast<int>(kMostLoops) * draw,
                   place, draw == 0 ? &out.report : nullptr);
      const FitCost again(own.refer(), cost.fixed(), tilt_deg);
      const std::vector<double> step = ownStep(
          cost, best,
          again.viewsAround(place, std::vector<Quadratic>(views.size(), Quadratic(n)), monitor));
      for (std::size_t i = 0; i < cost.dials(); ++i)
        out.error[i] += kOwnShare * step[i] / kOwnDraws;
      monitor.tell({Task::settings, static_cast<std::size_t>(draw) + 1,
                    static_cast<std::size_t>(kOwnDraws)});
    }
  } catch (const JobError&) {
    if (monitor.keep_going()) throw;
    return std::nullopt;
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
      at[i] += kPart * (0.5 * (u.low + u.high) - at[i]);
    }
  return moves > 0;
}

}  // namespace echocine::fit
