#pragma once
// A heart from one to three echo loops: its dials, ejection fraction and volumes with intervals.

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fit/fit_controls.h"
#include "fit/fit_cost.h"
#include "fit/fit_regions.h"
#include "fit/view_check.h"

namespace echocine::fit {

// A loop of a named view. The reference must outlive the fit.
struct FitLoop {
  heart::View view{};
  const echo::EchoLoop& loop;
  echo::SideOptions side{};
};
inline constexpr std::size_t kMostLoops = 3;

// Throws SceneError unless there are 1 to kMostLoops different views.
void checkFitViews(const std::vector<heart::View>& views);

struct HeartFitOptions {
  std::map<std::string, double> dials;  // fixed; other dials follow them
  // Keys of searchedDials(); none: dialsSearchedIn() the loops.
  std::optional<std::vector<std::string>> searched{};
  double tilt_deg = 12;  // limit of tilt and rotation of each plane; 0: planes as the view has them
  int starts = 12;       // hearts that are compared first: the groups' means, then draws
  int descents = 2;      // from the best of them
  // Fits the found heart's own rendered loops too: for regions and own_error.
  bool own_loops = true;
  // Measures the look of found hearts in their own rendered loops, and polishes the fit with it
  // (Eqs. 20 to 22 and 24). Takes five times as long. None: with two or three loops,
  // or one whose persistence is kMuchPersistence (fit_doubts.h) or more. Unless it is true or a
  // loop has this persistence, loops that do not look like own loops are fitted without
  // (kLeastAgreement, own_look_fit.h).
  std::optional<bool> own_look{};
  // Last steps of the best heart, each with a look of its own. A step leaves up to 0.8 of an error
  // in wall thickness, and less of others: the look moves with the heart. Our choice.
  int settling_steps = 6;
  bool other_views = true;  // compares the found heart in other views (view_check.h)
  int resamples = 0;  // blocks of the beat that are left out in turn (fit_resamples.h); 0: none
  std::filesystem::path heart_cache{};  // folder of computed hearts (HeartCache); empty: none
  // Keeps evaluations, so that a stopped fit resumes; none: nothing is kept.
  std::shared_ptr<FitJournal> journal{};

  bool ownLook(std::size_t loops) const { return own_look.value_or(loops > 1); }
};

// At 90 %.
struct Estimate {
  double value = 0, low = 0, high = 0;
};

struct DialFound {
  std::string key;
  double value = 0, sd = 0, prior_sd = 0;
  bool at_limit = false;
  bool determined = true;  // false: no narrower than the prior, which the value then is
};

// One view of the fitted heart.
struct ViewFitted {
  heart::View view{};
  BeatFound beat;
  PlaneTilt tilt;
  PoseFound found;
  bool scaled = true;                   // the loop has a length scale
  std::optional<double> persistence{};  // p of echo/persistence.h
  std::optional<OwnSight> own_sight{};  // measured with own_look or own_loops
  FitReport report;                     // of the best heart
  // D of the best heart in loops that do not show it; none if the fit was stopped.
  std::optional<ControlFits> controls{};
  std::optional<ViewRival> better{};  // another view that fits better
  std::optional<FitReport> own{};  // of the best heart in its own rendered loop, if that is fitted
  std::vector<RegionFinding> regions{};  // the same; empty without own loops
};

// SDs of Eq. 15; that of EDV is relative.
struct ModelError {
  double ef = 0, edv = 0, gls = 0;
};

// Another descent's end.
struct HeartRival {
  std::map<std::string, double> dials;
  double ef = 0, edv_ml = 0;
  std::optional<double> gls;  // none if no heart has these dials
  double cost_above = 0;      // J minus that of the best
};

struct HeartFit {
  std::map<std::string, double> dials;  // of the heart: fixed and found
  std::vector<DialFound> found;         // searched dials
  // Dials that are not searched and not defaults: those given, and the heart rate of the loops.
  std::map<std::string, double> fixed;
  double tilt_deg = 0;  // HeartFitOptions::tilt_deg
  // Empty if the loops do not determine the ejection fraction: `refusal` has the reason.
  std::optional<Estimate> ef;
  std::optional<Estimate> edv_ml, esv_ml;  // empty without a length scale too
  std::optional<Estimate> gls;             // Eq. 17 at end-systole; negative
  // By dial, the error of the same fit of the found heart's own rendered loops, in which
  // heart::SectionShape is held. Not subtracted.
  std::map<std::string, double> own_error;
  // By dial, Eq. 19; no SD is smaller. Empty without resamples.
  std::map<std::string, double> resampled_sd;
  std::vector<ViewFitted> views;
  std::vector<HeartRival> rivals;
  std::vector<std::string> hints;    // why the result is uncertain and what would help
  std::vector<std::string> assumed;  // of these loops
  std::string refusal;
  bool stopped = false;              // the best so far
  Look rendered_as = Look::scanner;  // of own loops
  bool own_look = false;  // J expects the own look of the heart, as far as each loop shows it
  std::optional<double> agreement;  // of Eq. 23: mean c over the views; none: not measured
  ModelError model_error;
  double cost = 0;  // J of Eq. 14
  double cpu_ms = 0;
};

// Throws SceneError for options out of range.
void checkFitOptions(const HeartFitOptions& options);

// Fits by Eq. 14: starts from the prior, then steps to the minimum of a quadratic through
// differences of J, from the best starts. Poses, tilts and dials are estimated jointly; the start
// and the end-systole of each loop's beat once, with the best start. Intervals: fit_interval.h.
// Throws SceneError for views that checkFitViews() refuses, options out of range, or a loop that
// ModelDiscrepancy refuses; JobError if it is stopped before a start is known. Runs in
// parallel; the result does not depend on the threads.
HeartFit fitHeart(const std::vector<FitLoop>& loops, const HeartFitOptions& options = {},
                  const Monitor& monitor = {});

}  // namespace echocine::fit
