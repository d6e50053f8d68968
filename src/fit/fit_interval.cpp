#include "fit/fit_interval.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "echo/persistence.h"
#include "fit/fit_doubts.h"
#include "fit/fit_strain.h"
#include "motion/heart/heart.h"

namespace echocine::fit {

namespace {

constexpr double kNinety = 1.645;  // SD of a normal distribution's central 90 %
// A posterior of more than this part of the prior's SD is not narrower. Our choice.
constexpr double kNarrower = 0.9;

struct Spread {
  double ef = 0, edv = 0, both = 0;  // variances and covariance
};

std::size_t unknownOf(const FitCost& cost, const char* key) {
  for (std::size_t i = 0; i < cost.dials(); ++i)
    if (cost.unknowns()[i].name == key) return i;
  return cost.unknowns().size();
}

double covarianceAt(const FitDescent& d, std::size_t i, std::size_t j) {
  const std::size_t n = d.best.at.size();
  return i < n && j < n && !d.covariance.empty() ? d.covariance[i * n + j] : 0;
}

Estimate estimateOf(double value, double variance) {
  const double half = kNinety * std::sqrt(std::max(0.0, variance));
  return {value, value - half, value + half};
}

void addDials(const FitCost& cost, const FitDescent& best, HeartFit& fit) {
  for (std::size_t i = 0; i < cost.dials(); ++i) {
    const FitUnknown& u = cost.unknowns()[i];
    DialFound dial{u.name, best.best.at[i], std::sqrt(covarianceAt(best, i, i)), 0, false, true};
    dial.prior_sd = cost.prior().sdOf(u.name).value_or(0);
    if (best.covariance.empty()) dial.sd = dial.prior_sd;
    const double near = 1e-3 * (u.high - u.low);
    dial.at_limit = dial.value < u.low + near || dial.value > u.high - near;
    // A fit that was stopped before is no statement on the loops.
    dial.determined =
        best.covariance.empty() || dial.prior_sd == 0 || dial.sd < kNarrower * dial.prior_sd;
    fit.found.push_back(dial);
  }
}

std::optional<double> strainAt(const std::map<std::string, double>& dials) {
  try {
    const heart::Parameters parameters = heart::parametersFrom(dials);
    if (!heart::faultOf(parameters).empty()) return std::nullopt;
    return longitudinalStrainOf(parameters);
  } catch (const SceneError&) {
    return std::nullopt;
  }
}

// g C g with the gradient g of the strain by dial.
double strainVariance(const FitCost& cost, const FitDescent& best, double value) {
  std::vector<double> slope;
  for (std::size_t i = 0; i < cost.dials(); ++i) {
    const FitUnknown& u = cost.unknowns()[i];
    std::vector<double> low = best.best.at, high = low;
    low[i] = std::max(u.low, low[i] - 0.5 * u.step);
    high[i] = std::min(u.high, high[i] + 0.5 * u.step);
    // A side without a heart is left out.
    const std::optional<double> below = strainAt(cost.dialsAt(low)),
                                above = strainAt(cost.dialsAt(high));
    const double rise = above.value_or(value) - below.value_or(value),
                 run = (above ? high[i] : best.best.at[i]) - (below ? low[i] : best.best.at[i]);
    slope.push_back(run > 0 ? rise / run : 0);
  }
  double sum = 0;
  for (std::size_t i = 0; i < slope.size(); ++i)
    for (std::size_t j = 0; j < slope.size(); ++j)
      sum += slope[i] * slope[j] * covarianceAt(best, i, j);
  return sum;
}

void addStrain(const FitCost& cost, const FitDescent& best, HeartFit& fit) {
  const std::optional<double> value = strainAt(fit.dials);
  if (!value) return;
  // Only for a fit that was stopped. Our choice.
  constexpr double kPriorSd = 0.04;
  const double model = fit.model_error.gls;
  fit.gls = estimateOf(*value, best.covariance.empty()
                                   ? kPriorSd * kPriorSd
                                   : strainVariance(cost, best, *value) + model * model);
}

void addResults(const FitCost& cost, const FitDescent& best, HeartFit& fit) {
  const std::size_t e = unknownOf(cost, "ef"), v = unknownOf(cost, "edv");
  const PriorDials dials = priorDialsOf(fit.dials);
  const ModelError error = fit.model_error;
  const double ef = dials[kEf], edv = dials[kEdv_ml];
  Spread s{covarianceAt(best, e, e) + error.ef * error.ef,
           covarianceAt(best, v, v) + std::pow(error.edv * edv, 2), covarianceAt(best, e, v)};
  if (best.covariance.empty())
    s = {std::pow(cost.prior().sd()[kEf], 2), std::pow(cost.prior().sd()[kEdv_ml], 2), 0};
  fit.ef = estimateOf(ef, s.ef);
  addStrain(cost, best, fit);
  const bool scaled = std::all_of(fit.views.begin(), fit.views.end(),
                                  [](const ViewFitted& view) { return view.scaled; });
  if (!scaled) return;
  fit.edv_ml = estimateOf(edv, s.edv);
  fit.esv_ml = estimateOf(
      edv * (1 - ef), (1 - ef) * (1 - ef) * s.edv + edv * edv * s.ef - 2 * edv * (1 - ef) * s.both);
}

void addRivals(const FitCost& cost, const std::vector<FitDescent>& descents, HeartFit& fit) {
  for (std::size_t i = 1; i < descents.size(); ++i) {
    const FitPlace& other = descents[i].best;
    // A best heart that had to be moved (makePossible) may have become worse than its rivals.
    HeartRival rival{cost.dialsAt(other.at), 0, 0, {}, std::max(0.0, other.cost - fit.cost)};
    rival.gls = strainAt(rival.dials);
    const PriorDials dials = priorDialsOf(rival.dials);
    rival.ef = dials[kEf], rival.edv_ml = dials[kEdv_ml];
    fit.rivals.push_back(rival);
  }
}

void widen(Estimate& e, double other) {
  e.low = std::min(e.low, other);
  e.high = std::max(e.high, other);
}

// By rivals that fit nearly as well.
void widenByRivals(HeartFit& fit) {
  for (const HeartRival& rival : fit.rivals) {
    if (!fit.ef || rival.cost_above > kRival) continue;
    widen(*fit.ef, rival.ef);
    if (fit.gls && rival.gls) widen(*fit.gls, *rival.gls);
    if (!fit.edv_ml) continue;
    widen(*fit.edv_ml, rival.edv_ml);
    widen(*fit.esv_ml, rival.edv_ml * (1 - rival.ef));
  }
}

}  // namespace

double agreementOf(const std::vector<OwnSight>& sights) {
  double sum = 0;
  for (const OwnSight& sight : sights) sum += sight.greys;
  return sum / static_cast<double>(sights.size());
}

std::optional<double> agreementOf(const std::vector<ViewFitted>& views) {
  std::vector<OwnSight> sights;
  for (const ViewFitted& view : views) {
    if (!view.own_sight) return std::nullopt;
    sights.push_back(*view.own_sight);
  }
  return agreementOf(sights);
}

double lagBeatsOf(const std::vector<ViewFitted>& views) {
  double sum = 0;
  for (const ViewFitted& view : views)
    if (view.beat.span.frames > 0)
      sum += echo::lagFrames(view.persistence.value_or(0)) / view.beat.span.frames;
  return views.empty() ? 0 : sum / static_cast<double>(views.size());
}

ModelError modelErrorOf(std::size_t views, bool own_look, std::optional<double> agreement,
                        double lag_beats) {
  // Hearts of the family, by the number of views; growth outside it.
  constexpr ModelError kPlain[] = {
      {0.015, 0.085, 0.009}, {0.015, 0.05, 0.009}, {0.015, 0.045, 0.009}};
  constexpr ModelError kWithOwnLook[] = {kPlain[0], {0.01, 0.05, 0.009}, {0.01, 0.025, 0.009}};
  constexpr ModelError kOutside{0.14, 0.18, 0.035};
  const std::size_t row = std::clamp(views, std::size_t{1}, kMostLoops) - 1;
  const ModelError& inside = own_look ? kWithOwnLook[row] : kPlain[row];
  const double beyond = 1 - std::clamp(agreement.value_or(kUnmeasuredAgreement), 0.0, 1.0);
  constexpr double kLagOfEf = 0.6, kLagOfStrain = 0.35;
  return {std::hypot(inside.ef, beyond * kOutside.ef, kLagOfEf * lag_beats),
          std::hypot(inside.edv, beyond * kOutside.edv),
          std::hypot(inside.gls, beyond * kOutside.gls, kLagOfStrain * lag_beats)};
}

void concludeFit(const FitCost& cost, const std::vector<FitDescent>& descents, HeartFit& fit) {
  const FitDescent& best = descents.front();
  fit.cost = best.best.cost;
  fit.dials = cost.dialsAt(best.best.at);
  fit.agreement = agreementOf(fit.views);
  fit.model_error =
      modelErrorOf(fit.views.size(), fit.own_look, fit.agreement, lagBeatsOf(fit.views));
  addDials(cost, best, fit);
  addRivals(cost, descents, fit);
  fit.refusal = refusalOf(fit);
  if (fit.refusal.empty()) addResults(cost, best, fit);
  addHints(fit);
  widenByRivals(fit);
}

}  // namespace echocine::fit
