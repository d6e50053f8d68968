#include "fit/fit_interval.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fit/caveats.h"

namespace echocine::fit {

namespace {

constexpr double kNinety = 1.645;  // SD of a normal distribution's central 90 %
constexpr double kRival = 3;       // J: a rival a twentieth as likely still counts
// D above which a model explains hardly more than none. Our choice.
constexpr double kMostD = 0.9;
constexpr double kLeastInSight = 0.6;
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

void widen(Estimate& e, double other) {
  e.low = std::min(e.low, other);
  e.high = std::max(e.high, other);
}

void addDials(const FitCost& cost, const FitDescent& best, HeartFit& fit) {
  for (std::size_t i = 0; i < cost.dials(); ++i) {
    const FitUnknown& u = cost.unknowns()[i];
    DialFound dial{u.name, best.best.at[i], std::sqrt(covarianceAt(best, i, i)), 0, false, true};
    if (const auto p = priorDialOf(u.name)) dial.prior_sd = cost.prior().sd()[*p];
    if (best.covariance.empty()) dial.sd = dial.prior_sd;
    const double near = 1e-3 * (u.high - u.low);
    dial.at_limit = dial.value < u.low + near || dial.value > u.high - near;
    dial.told = dial.prior_sd == 0 || dial.sd < kNarrower * dial.prior_sd;
    fit.found.push_back(dial);
  }
}

void addHints(HeartFit& fit) {
  const auto hint = [&](const std::string& text) { fit.hints.push_back(text); };
  for (const DialFound& dial : fit.found) {
    if (dial.at_limit)
      hint(
          fmt::format("{} is at its limit {:.4g}: the heart may lie beyond", dial.key, dial.value));
    if (!dial.told)
      hint(
          fmt::format("{} is not determined by the loops: its value is the prior's; another view "
                      "would help",
                      dial.key));
  }
  for (const ViewFitted& view : fit.views) {
    const char* name = keyOf(view.view);
    if (view.beat.confidence < kLeastConfidence)
      hint(fmt::format("{}: the start of the beat is ambiguous: give end-diastole", name));
    if (view.found.terms.overlap < kLeastInSight)
      hint(fmt::format("{}: shows only {:.0f} % of the heart", name,
                       100 * view.found.terms.overlap));
    if (view.found.at_limit) hint(fmt::format("{}: the pose is at the limit of its search", name));
  }
}

// One line; empty if the loops determine the ejection fraction.
std::string refusalOf(const HeartFit& fit) {
  for (const ViewFitted& view : fit.views)
    if (view.found.discrepancy > kMostD)
      return fmt::format("{}: no heart explains this loop (D {:.2f}): is it this view, and a beat?",
                         keyOf(view.view), view.found.discrepancy);
  for (const DialFound& dial : fit.found)
    if (dial.key == "ef" && !dial.told)
      return "the loops do not determine the ejection fraction: another view would help";
  return {};
}

void addResults(const FitCost& cost, const FitDescent& best, HeartFit& fit) {
  const std::size_t e = unknownOf(cost, "ef"), v = unknownOf(cost, "edv");
  const PriorDials dials = priorDialsOf(fit.dials);
  const ModelError error = modelErrorOf(fit.views.size());
  const double ef = dials[kEf], edv = dials[kEdv_ml];
  Spread s{covarianceAt(best, e, e) + error.ef * error.ef,
           covarianceAt(best, v, v) + std::pow(error.edv * edv, 2), covarianceAt(best, e, v)};
  if (best.covariance.empty())
    s = {std::pow(cost.prior().sd()[kEf], 2), std::pow(cost.prior().sd()[kEdv_ml], 2), 0};
  fit.ef = estimateOf(ef, s.ef);
  const bool scaled = std::all_of(fit.views.begin(), fit.views.end(),
                                  [](const ViewFitted& view) { return view.scaled; });
  if (!scaled) {
    fit.hints.push_back("a loop has no length scale: volumes are left out; give its scale");
    return;
  }
  fit.edv_ml = estimateOf(edv, s.edv);
  fit.esv_ml = estimateOf(
      edv * (1 - ef), (1 - ef) * (1 - ef) * s.edv + edv * edv * s.ef - 2 * edv * (1 - ef) * s.both);
}

void addRivals(const FitCost& cost, const std::vector<FitDescent>& descents, HeartFit& fit) {
  const Estimate ef = fit.ef.value_or(Estimate{});
  for (std::size_t i = 1; i < descents.size(); ++i) {
    const FitPlace& other = descents[i].best;
    HeartRival rival{cost.dialsAt(other.at), 0, 0, other.cost - fit.cost};
    const PriorDials dials = priorDialsOf(rival.dials);
    rival.ef = dials[kEf], rival.edv_ml = dials[kEdv_ml];
    fit.rivals.push_back(rival);
    if (!fit.ef || rival.cost_above > kRival) continue;
    if (rival.ef < ef.low || rival.ef > ef.high)
      fit.hints.push_back(fmt::format(
          "another heart with EF {:.2f} fits nearly as well: another view would help", rival.ef));
    widen(*fit.ef, rival.ef);
    if (!fit.edv_ml) continue;
    widen(*fit.edv_ml, rival.edv_ml);
    widen(*fit.esv_ml, rival.edv_ml * (1 - rival.ef));
  }
}

}  // namespace

ModelError modelErrorOf(std::size_t views) {
  return views <= 1   ? ModelError{0.040, 0.08}
         : views == 2 ? ModelError{0.035, 0.06}
                      : ModelError{0.030, 0.05};
}

void concludeFit(const FitCost& cost, const std::vector<FitDescent>& descents, HeartFit& fit) {
  const FitDescent& best = descents.front();
  fit.cost = best.best.cost;
  fit.dials = cost.dialsAt(best.best.at);
  addDials(cost, best, fit);
  addHints(fit);
  fit.refusal = refusalOf(fit);
  if (fit.refusal.empty()) addResults(cost, best, fit);
  addRivals(cost, descents, fit);
}

}  // namespace echocine::fit
