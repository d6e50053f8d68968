#include "fit/fit_doubts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "fit/caveats.h"

namespace echocine::fit {

namespace {

// A control fits as well as the loop itself, by Eq. 14 for one view.
bool asGood(double control, double own) {
  return 0.5 * kLoopSamples * std::log(std::max(control, 1e-3) / std::max(own, 1e-3)) < kRival;
}

std::string refusalOfView(const ViewFitted& view) {
  const char* name = keyOf(view.view);
  if (view.found.discrepancy > kMostD)
    return fmt::format("{}: no heart explains this loop (D {:.2f}): is it this view, and a beat?",
                       name, view.found.discrepancy);
  if (!view.controls) return {};
  const bool fits_others = asGood(view.controls->shuffled, view.controls->own) ||
                           asGood(view.controls->mirrored, view.controls->own);
  if (fits_others && view.beat.length_source == kLoopIsBeat)
    return fmt::format(
        "{}: the heart fits changed pictures as well (D mirrored {:.3f}, shuffled {:.3f}, own "
        "{:.3f}), and the loop does not close: give a loop of a whole beat",
        name, view.controls->mirrored, view.controls->shuffled, view.controls->own);
  if (asGood(view.controls->shuffled, view.controls->own))
    return fmt::format(
        "{}: the heart fits the shuffled pictures as well (D {:.3f}, own {:.3f}): does the loop "
        "show a whole beat of {} without a change of the plane?",
        name, view.controls->shuffled, view.controls->own, name);
  if (asGood(view.controls->mirrored, view.controls->own))
    return fmt::format(
        "{}: the heart fits the mirror image as well (D {:.3f}, own {:.3f}): is it this view, and "
        "not flipped left to right?",
        name, view.controls->mirrored, view.controls->own);
  return {};
}

void addDialHints(HeartFit& fit) {
  for (const DialFound& dial : fit.found) {
    if (dial.at_limit)
      fit.hints.push_back(fmt::format(
          "{} is at its limit {:.4g}: the heart may lie beyond; another view would help", dial.key,
          dial.value));
    if (!dial.determined && !heart::isSectionDial(dial.key))
      fit.hints.push_back(
          fmt::format("{} is not determined by the loops: its value is the prior's; another view "
                      "would help",
                      dial.key));
  }
}

void addAssumed(const char* key, const char* unit, const std::optional<Estimate>& e,
                HeartFit& fit) {
  const bool searched = std::any_of(fit.found.begin(), fit.found.end(),
                                    [&](const DialFound& dial) { return dial.key == key; });
  if (e && !searched)
    fit.hints.push_back(fmt::format(
        "{} is not searched: {:.4g}{} is assumed, and its interval has the model error alone", key,
        e->value, unit));
}

void addViewHints(const ViewFitted& view, HeartFit& fit) {
  const char* name = keyOf(view.view);
  const auto hint = [&](const std::string& text) {
    fit.hints.push_back(fmt::format("{}: {}", name, text));
  };
  if (view.beat.confidence < kLeastConfidence)
    hint("the start of the beat is ambiguous: give its end-diastole (--ed, ed_frame)");
  if (view.beat.length_source == kLoopIsBeat)
    hint(
        "the length of the beat is unknown and the loop does not close: a part of a beat? Give a "
        "loop of a whole beat");
  if (view.better)
    hint(
        fmt::format("the heart in {} explains this loop better (V {:.3f}, in {} {:.3f}): is it "
                    "this view?",
                    keyOf(view.better->view), view.better->other, name, view.better->own));
  if (view.found.terms.overlap < kLeastInSight)
    hint(fmt::format("shows only {:.0f} % of the heart: a loop with the whole ventricle would help",
                     100 * view.found.terms.overlap));
  if (view.persistence.value_or(0) >= kMuchPersistence)
    hint(fmt::format(
        "its pictures are averaged over time (persistence of about {:.1f}), so the ejection "
        "fraction may be too low: a loop without persistence would help",
        *view.persistence));
  if (view.found.at_limit)
    hint(fmt::format("the pose is at the limit of its search: is it this view{}?",
                     view.scaled ? " and this scale (--scale, mm_per_pixel)" : ""));
}

}  // namespace

std::string refusalOf(const HeartFit& fit) {
  for (const ViewFitted& view : fit.views)
    if (std::string text = refusalOfView(view); !text.empty()) return text;
  for (const DialFound& dial : fit.found)
    if (dial.key == "ef" && !dial.determined)
      return "the loops do not determine the ejection fraction: another view would help";
  return {};
}

void addHints(HeartFit& fit) {
  addDialHints(fit);
  addAssumed("ef", "", fit.ef, fit);
  addAssumed("edv", " mL", fit.edv_ml, fit);
  for (const ViewFitted& view : fit.views) addViewHints(view, fit);
  if (!std::all_of(fit.views.begin(), fit.views.end(),
                   [](const ViewFitted& view) { return view.scaled; }))
    fit.hints.emplace_back(
        "a loop has no length scale: volumes are left out; give it (--scale, mm_per_pixel)");
  for (const HeartRival& rival : fit.rivals)
    if (fit.ef && rival.cost_above <= kRival && (rival.ef < fit.ef->low || rival.ef > fit.ef->high))
      fit.hints.push_back(fmt::format(
          "another heart with EF {:.2f} fits nearly as well: another view would help", rival.ef));
}

}  // namespace echocine::fit
