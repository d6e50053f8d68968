#include "fit/fit_cost.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "fit/searched_dials.h"
#include "motion/heart/left_ventricle.h"

namespace echocine::fit {

// Minus the log-likelihood. D is never 0: no loop is without noise.
double viewCostOf(double discrepancy) {
  return 0.5 * kLoopSamples * std::log(std::max(discrepancy, 1e-3));
}

ModelLoop FitSide::modelAt(const std::vector<double>& values, const PlaneTilt& tilt) const {
  ModelLoop model = family->at(values, tilt, Focus::left_ventricle);
  look->applyTo(model);
  return model;
}

PriorDials priorDialsOf(const std::map<std::string, double>& dials) {
  const heart::Parameters parameters = heart::parametersFrom(dials);
  PriorDials out{};
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = dialOf("dials", kPriorDials[i]).get(parameters).value_or(heart::outlineConicity());
  out[priorDialOf("sphericity").value()] = heart::sphericityOf(parameters);
  return out;
}

FitCost::FitCost(std::vector<FitSide> sides, const std::map<std::string, double>& dials,
                 double tilt_deg, FitMemory memory)
    : sides_(std::move(sides)), fixed_(dials), tilts_(tilt_deg > 0), memory_(std::move(memory)) {
  for (const DialRange& range : sides_.front().family->ranges())
    unknowns_.push_back(
        {range.key, range.low, range.high, stepOf(range), heart::isSectionDial(range.key)});
  dials_ = unknowns_.size();
  constexpr double kTiltStep_deg = 2.5, kRotateStep_deg = 4;
  for (std::size_t v = 0; tilts_ && v < sides_.size(); ++v) {
    // Differences need a step to both sides within the limits.
    unknowns_.push_back({"tilt", -tilt_deg, tilt_deg, std::min(kTiltStep_deg, tilt_deg)});
    unknowns_.push_back({"rotate", -tilt_deg, tilt_deg, std::min(kRotateStep_deg, tilt_deg)});
  }
}

std::vector<std::size_t> FitCost::unknownsOf(std::size_t view) const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < dials_; ++i) out.push_back(i);
  if (tilts_) out.insert(out.end(), {dials_ + 2 * view, dials_ + 2 * view + 1});
  return out;
}

std::vector<std::size_t> FitCost::freeOf(std::size_t view) const {
  std::vector<std::size_t> out = unknownsOf(view);
  std::erase_if(out, [&](std::size_t i) { return unknowns_[i].held; });
  return out;
}

FitCost FitCost::with(std::vector<FitSide> sides, FitMemory memory) const {
  FitCost out = *this;
  out.sides_ = std::move(sides);
  out.memory_ = std::move(memory);
  return out;
}

void FitCost::searchSections() {
  for (FitUnknown& u : unknowns_) u.held = false;
}

std::vector<double> FitCost::searchedAt(const std::vector<double>& at) const {
  return {at.begin(), at.begin() + static_cast<std::ptrdiff_t>(dials_)};
}

std::map<std::string, double> FitCost::dialsAt(const std::vector<double>& at) const {
  std::map<std::string, double> dials = fixed_;
  for (std::size_t i = 0; i < dials_; ++i) dials[unknowns_[i].name] = at[i];
  addFollowers(dials);
  return dials;
}

PlaneTilt FitCost::tiltAt(const std::vector<double>& at, std::size_t view) const {
  if (!tilts_) return {};
  return {radiansFromDegrees(at[dials_ + 2 * view]), radiansFromDegrees(at[dials_ + 2 * view + 1])};
}

double FitCost::priorCost(const std::vector<double>& at) const {
  double cost = -prior_.logDensity(priorDialsOf(dialsAt(at)));
  for (std::size_t i = 0; i < dials_; ++i)
    if (const LonePrior* lone = lonePriorOf(unknowns_[i].name)) cost -= lone->logDensity(at[i]);
  for (std::size_t i = dials_; i < at.size(); i += 2)
    cost += 0.5 * std::pow(at[i] / kTiltSd_deg, 2) + 0.5 * std::pow(at[i + 1] / kRotateSd_deg, 2);
  return cost;
}

double FitCost::viewCost(std::size_t view, const std::vector<double>& at,
                         const PoseFound& found) const {
  std::vector<double> own;
  for (const std::size_t i : unknownsOf(view)) own.push_back(at[i]);
  return viewCostOf(found.discrepancy - sides_[view].look->slope.of(own));
}

PoseFound FitCost::viewAt(std::size_t view, const std::vector<double>& at,
                          const PoseFound* from) const {
  const std::vector<double> values = searchedAt(at);
  const PlaneTilt tilt = tiltAt(at, view);
  if (!memory_.journal) return evaluated(view, values, tilt, from);
  const std::string key =
      FitJournal::keyOf(memory_.stage, view, values, tilt, from != nullptr ? &from->pose : nullptr);
  if (auto known = memory_.journal->find(key)) return *known;
  const PoseFound found = evaluated(view, values, tilt, from);
  memory_.journal->add(key, found);
  return found;
}

PoseFound FitCost::evaluated(std::size_t view, const std::vector<double>& values,
                             const PlaneTilt& tilt, const PoseFound* from) const {
  const FitSide& side = sides_[view];
  const ModelLoop model = side.modelAt(values, tilt);
  return from != nullptr ? side.discrepancy->refine(model, {from->pose})
                         : side.discrepancy->search(model);
}

FitPlace FitCost::at(const std::vector<double>& at, const std::vector<PoseFound>& from) const {
  FitPlace out{at, std::vector<PoseFound>(sides_.size()), priorCost(at)};
  parallelBlocks(sides_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      out.found[v] = viewAt(v, at, from.empty() ? nullptr : &from[v]);
  });
  for (std::size_t v = 0; v < sides_.size(); ++v) out.cost += viewCost(v, at, out.found[v]);
  return out;
}

std::vector<double> FitCost::moved(const std::vector<double>& from,
                                   const std::vector<double>& steps) const {
  std::vector<double> out = from;
  for (std::size_t i = 0; i < out.size(); ++i) {
    const FitUnknown& u = unknowns_[i];
    if (!u.held) out[i] = std::clamp(out[i] + u.step * steps[i], u.low, u.high);
  }
  return out;
}

std::vector<double> FitCost::minimumNear(const Quadratic& q, const std::vector<double>& from,
                                         const std::vector<double>& most_steps) const {
  std::vector<double> low, high;
  for (std::size_t i = 0; i < from.size(); ++i) {
    const FitUnknown& u = unknowns_[i];
    low.push_back(std::max(-most_steps[i], (u.low - from[i]) / u.step));
    high.push_back(std::min(most_steps[i], (u.high - from[i]) / u.step));
  }
  return moved(from, minimumWithin(q, low, high));
}

std::vector<double> FitCost::stepsBetween(const std::vector<double>& from,
                                          const std::vector<double>& to) const {
  std::vector<double> out;
  for (std::size_t i = 0; i < from.size(); ++i)
    out.push_back((to[i] - from[i]) / unknowns_[i].step);
  return out;
}

bool FitCost::within(double steps, const std::vector<double>& a,
                     const std::vector<double>& b) const {
  for (std::size_t i = 0; i < a.size(); ++i)
    if (std::abs(a[i] - b[i]) > steps * unknowns_[i].step) return false;
  return true;
}

std::vector<double> FitCost::middleOf(const std::vector<double>& at) const {
  std::vector<double> middle = at;
  for (std::size_t i = 0; i < middle.size(); ++i) {
    const FitUnknown& u = unknowns_[i];
    if (!u.held) middle[i] = std::clamp(middle[i], u.low + u.step, u.high - u.step);
  }
  return middle;
}

Quadratic FitCost::viewAround(std::size_t view, const PoseFound& from,
                              const std::vector<double>& middle, const Quadratic* mixed,
                              const Monitor& monitor) const {
  const auto values = [&](const std::vector<std::vector<double>>& places) {
    std::vector<double> out(places.size());
    parallelBlocks(places.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        if (!monitor.keep_going()) throw JobError("stopped while a heart was fitted");
        const std::vector<double> at = moved(middle, places[i]);
        out[i] = viewCost(view, at, viewAt(view, at, &from));
      }
    });
    return out;
  };
  return differencesOf(unknowns_.size(), freeOf(view), values, mixed);
}

std::vector<Quadratic> FitCost::viewsAround(const FitPlace& place,
                                            const std::vector<Quadratic>& mixed,
                                            const Monitor& monitor) const {
  const std::vector<double> middle = middleOf(place.at);
  std::vector<Quadratic> out;
  for (std::size_t v = 0; v < sides_.size(); ++v)
    out.push_back(
        viewAround(v, place.found[v], middle, mixed.empty() ? nullptr : &mixed[v], monitor));
  return out;
}

std::array<std::vector<double>, 2> FitCost::besideIn(std::size_t unknown,
                                                     const std::vector<double>& at) const {
  std::vector<double> steps(at.size());
  const auto movedBy = [&](double step) {
    steps[unknown] = step;
    return moved(at, steps);
  };
  return {movedBy(-kSlopeStep), movedBy(kSlopeStep)};
}

std::vector<double> FitCost::slopesAt(const FitPlace& place, const Monitor& monitor) const {
  struct Difference {
    std::size_t view, unknown;
  };
  std::vector<Difference> all;
  for (std::size_t v = 0; v < views(); ++v)
    for (const std::size_t u : freeOf(v)) all.push_back({v, u});
  const auto slopeOf = [&](std::size_t unknown, const auto& cost) {
    const auto [low, high] = besideIn(unknown, place.at);
    return (cost(high) - cost(low)) / (high[unknown] - low[unknown]);
  };
  std::vector<double> slopes(all.size());
  parallelBlocks(all.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (!monitor.keep_going()) throw JobError("stopped while a heart was fitted");
      const auto [v, u] = all[i];
      slopes[i] = slopeOf(u, [&, v = v](const std::vector<double>& at) {
        return viewCost(v, at, viewAt(v, at, &place.found[v]));
      });
    }
  });
  std::vector<double> out;
  for (std::size_t u = 0; u < unknowns_.size(); ++u)
    out.push_back(unknowns_[u].held ? 0 : slopeOf(u, [&](const std::vector<double>& at) {
      return priorCost(at);
    }));
  for (std::size_t i = 0; i < all.size(); ++i) out[all[i].unknown] += slopes[i];
  return out;
}

// In units of the prior's SD no curvature is below 1.
Quadratic FitCost::priorAround(const std::vector<double>& middle) const {
  const std::size_t n = unknowns_.size();
  std::vector<std::size_t> all;
  std::vector<double> scale;
  for (std::size_t i = 0; i < n; ++i) {
    all.push_back(i);
    scale.push_back(priorSd(i) / unknowns_[i].step);
  }
  Quadratic q = differencesOf(n, all, [&](const std::vector<std::vector<double>>& places) {
    std::vector<double> values;
    for (const std::vector<double>& place : places)
      values.push_back(priorCost(moved(middle, place)));
    return values;
  });
  const auto rescale = [&](bool into) {
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        const double both = scale[i] * scale[j];
        q.bend(i, j) *= into ? both : 1 / both;
      }
  };
  rescale(true);
  q = convex(q, 1);
  rescale(false);
  return q;
}

double FitCost::priorSd(std::size_t unknown) const {
  const FitUnknown& u = unknowns_[unknown];
  if (unknown >= dials_) return (unknown - dials_) % 2 == 0 ? kTiltSd_deg : kRotateSd_deg;
  return prior_.sdOf(u.name).value_or((u.high - u.low) / std::sqrt(12.0));
}

// The prior's differences stay within the limits.
Quadratic FitCost::sumOf(const std::vector<Quadratic>& views,
                         const std::vector<double>& place) const {
  const std::vector<double> middle = middleOf(place);
  return sumOfViews(priorAround(middle).movedTo(stepsBetween(middle, place)), views);
}

std::vector<double> FitCost::covariance(const Quadratic& q) const {
  std::vector<double> out = covarianceOf(q);
  for (std::size_t i = 0; i < q.size(); ++i)
    for (std::size_t j = 0; j < q.size(); ++j)
      out[i * q.size() + j] *= unknowns_[i].step * unknowns_[j].step;
  return out;
}

}  // namespace echocine::fit
