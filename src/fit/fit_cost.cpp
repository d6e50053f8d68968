#include "fit/fit_cost.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "fit/searched_dials.h"

namespace echocine::fit {

namespace {

// Minus the log-likelihood. D is never 0: no loop is without noise.
double lossOf(double discrepancy) {
  return 0.5 * kLoopSamples * std::log(std::max(discrepancy, 1e-3));
}

// Central differences of a function of the listed unknowns in units of a step.
template <typename Values>
Quadratic differencesOf(std::size_t all, const std::vector<std::size_t>& of, const Values& values) {
  std::vector<std::vector<double>> places{std::vector<double>(all, 0)};
  const auto add = [&](std::size_t i, double a, std::size_t j, double b) {
    places.emplace_back(all, 0);
    places.back()[i] += a;
    places.back()[j] += b;
  };
  for (const std::size_t i : of) add(i, 1, i, 0), add(i, -1, i, 0);
  for (std::size_t a = 0; a < of.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) add(of[a], 1, of[b], 1);
  const std::vector<double> y = values(places);
  Quadratic out(all);
  out.value = y[0];
  for (std::size_t a = 0; a < of.size(); ++a) {
    out.gradient[of[a]] = 0.5 * (y[1 + 2 * a] - y[2 + 2 * a]);
    out.bend(of[a], of[a]) = y[1 + 2 * a] - 2 * y[0] + y[2 + 2 * a];
  }
  std::size_t next = 1 + 2 * of.size();
  for (std::size_t a = 0; a < of.size(); ++a)
    for (std::size_t b = 0; b < a; ++b, ++next) {
      const std::size_t i = of[a], j = of[b];
      out.bend(i, j) = out.bend(j, i) = y[next] - y[0] - out.gradient[i] - out.gradient[j] -
                                        0.5 * (out.hessian[i * all + i] + out.hessian[j * all + j]);
    }
  return out;
}

void addTo(Quadratic& sum, const Quadratic& one) {
  sum.value += one.value;
  for (std::size_t i = 0; i < sum.gradient.size(); ++i) sum.gradient[i] += one.gradient[i];
  for (std::size_t i = 0; i < sum.hessian.size(); ++i) sum.hessian[i] += one.hessian[i];
}

}  // namespace

PriorDials priorDialsOf(const std::map<std::string, double>& dials) {
  const heart::Parameters parameters = heart::parametersFrom(dials);
  PriorDials out{};
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = dialOf("dials", kPriorDials[i]).get(parameters).value_or(0);
  return out;
}

FitCost::FitCost(std::vector<FitSide> sides, const std::map<std::string, double>& dials,
                 double tilt_deg)
    : sides_(std::move(sides)), fixed_(dials), tilts_(tilt_deg > 0) {
  for (const DialRange& range : sides_.front().family->ranges())
    unknowns_.push_back({range.key, range.low, range.high, stepOf(range)});
  dials_ = unknowns_.size();
  constexpr double kTiltStep_deg = 1.5, kRotateStep_deg = 2.5;
  for (std::size_t v = 0; tilts_ && v < sides_.size(); ++v) {
    unknowns_.push_back({"tilt", -tilt_deg, tilt_deg, kTiltStep_deg});
    unknowns_.push_back({"rotate", -tilt_deg, tilt_deg, kRotateStep_deg});
  }
}

std::vector<std::size_t> FitCost::unknownsOf(std::size_t view) const {
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < dials_; ++i) out.push_back(i);
  if (tilts_) out.insert(out.end(), {dials_ + 2 * view, dials_ + 2 * view + 1});
  return out;
}

std::vector<double> FitCost::searchedAt(const std::vector<double>& at) const {
  return {at.begin(), at.begin() + static_cast<std::ptrdiff_t>(dials_)};
}

std::map<std::string, double> FitCost::dialsAt(const std::vector<double>& at) const {
  std::map<std::string, double> dials = fixed_;
  for (std::size_t i = 0; i < dials_; ++i) dials[unknowns_[i].name] = at[i];
  return dials;
}

PlaneTilt FitCost::tiltAt(const std::vector<double>& at, std::size_t view) const {
  if (!tilts_) return {};
  return {radiansFromDegrees(at[dials_ + 2 * view]), radiansFromDegrees(at[dials_ + 2 * view + 1])};
}

double FitCost::priorCost(const std::vector<double>& at) const {
  double cost = -prior_.logDensity(priorDialsOf(dialsAt(at)));
  for (std::size_t i = dials_; i < at.size(); i += 2)
    cost += 0.5 * std::pow(at[i] / kTiltSd_deg, 2) + 0.5 * std::pow(at[i + 1] / kRotateSd_deg, 2);
  return cost;
}

PoseFound FitCost::viewAt(std::size_t view, const std::vector<double>& at,
                          const PoseFound* from) const {
  const FitSide& side = sides_[view];
  const ModelLoop model = side.family->at(searchedAt(at), tiltAt(at, view));
  return from != nullptr ? side.discrepancy->refine(model, {from->pose})
                         : side.discrepancy->search(model);
}

FitPlace FitCost::at(const std::vector<double>& at, const std::vector<PoseFound>& from) const {
  FitPlace out{at, std::vector<PoseFound>(sides_.size()), priorCost(at)};
  parallelBlocks(sides_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      out.found[v] = viewAt(v, at, from.empty() ? nullptr : &from[v]);
  });
  for (const PoseFound& found : out.found) out.cost += lossOf(found.discrepancy);
  return out;
}

std::vector<double> FitCost::moved(const std::vector<double>& from,
                                   const std::vector<double>& steps, double part) const {
  std::vector<double> out = from;
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = std::clamp(out[i] + part * unknowns_[i].step * steps[i], unknowns_[i].low,
                        unknowns_[i].high);
  return out;
}

Quadratic FitCost::viewAround(std::size_t view, const PoseFound& from,
                              const std::vector<double>& middle, double part,
                              const Monitor& monitor) const {
  return differencesOf(
      unknowns_.size(), unknownsOf(view), [&](const std::vector<std::vector<double>>& places) {
        std::vector<double> values(places.size());
        parallelBlocks(places.size(), 1, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            if (!monitor.keep_going()) throw JobError("stopped while a heart was fitted");
            values[i] = lossOf(viewAt(view, moved(middle, places[i], part), &from).discrepancy);
          }
        });
        return values;
      });
}

Quadratic FitCost::priorAround(const std::vector<double>& middle, double part) const {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < unknowns_.size(); ++i) all.push_back(i);
  return differencesOf(unknowns_.size(), all, [&](const std::vector<std::vector<double>>& places) {
    std::vector<double> values;
    for (const std::vector<double>& place : places)
      values.push_back(priorCost(moved(middle, place, part)));
    return values;
  });
}

Quadratic FitCost::around(const FitPlace& place, double part, std::vector<double>& middle,
                          const Monitor& monitor) const {
  middle = place.at;
  for (std::size_t i = 0; i < middle.size(); ++i) {
    const double step = part * unknowns_[i].step;
    middle[i] = std::clamp(middle[i], unknowns_[i].low + step, unknowns_[i].high - step);
  }
  Quadratic sum = priorAround(middle, part);
  for (std::size_t v = 0; v < sides_.size(); ++v)
    addTo(sum, viewAround(v, place.found[v], middle, part, monitor));
  return sum;
}

}  // namespace echocine::fit
