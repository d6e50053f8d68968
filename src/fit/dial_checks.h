#pragma once
// Checks of dials, ranges, places and poses from a caller. Every message starts with the name of
// the argument and ends with the accepted values.

#include <map>
#include <span>
#include <string>
#include <vector>

#include "fit/fit_terms.h"
#include "motion/heart/parameters.h"

namespace echocine::fit {

// The end-diastolic volume of the right ventricle over that of the left one. A dial of fits and
// families only, in place of rv-edv: not every right ventricle fits around every left one.
inline constexpr const char* kRightRatio = "rv-ratio";

// A dial and its range.
struct DialRange {
  std::string key;  // of heart::dials(), or kRightRatio
  double low = 0, high = 0;
};

// Hearts that a family may compute, and nodes of each of its dials. Our choice: 125 hearts take two
// minutes of one core.
inline constexpr int kLeastNodes = 2, kMostNodes = 9;
inline constexpr std::size_t kMostHearts = 125;

// The dial of a key, kRightRatio included. Throws SceneError for an unknown one.
const heart::Dial& dialOf(const std::string& argument, const std::string& key);
// Throws SceneError unless the value is within the dial's range.
void checkDial(const std::string& argument, const heart::Dial& dial, double value);

// A family's input. `ranges`: different dials, low below high, within the range of the dial.
// `dials`: values within their ranges, of none of the dials in `ranges`. Together they have at most
// one of kRightRatio and rv-edv. Throws SceneError.
void checkRanges(const std::map<std::string, double>& dials, const std::vector<DialRange>& ranges);
// Nodes of each dial of a grid. nodes^ranges hearts are at most kMostHearts. Throws SceneError.
void checkNodes(const std::vector<DialRange>& ranges, int nodes);

// One value per range, within it to rounding: beyond its nodes a polynomial is no heart. Throws
// SceneError.
void checkValues(const std::vector<DialRange>& ranges, std::span<const double> values);

// Limits of a pose that is evaluated. Our choice: beyond them a model of a heart leaves every real
// sector. A search has the narrower PoseLimits.
inline constexpr double kMostShift_m = 0.5, kLeastScale = 0.2, kMostScale = 5;
inline constexpr int kMostLag = 1000;
inline constexpr double kEarliestSystole = 0.05, kLatestSystole = 0.95;  // or 0: that of the stack
// Throws SceneError for a pose beyond the limits, or with a number that is not finite.
void checkPose(const FitPose& pose);
// The same for starts of a search. Throws also without any, or for different times.
void checkStarts(const std::vector<FitPose>& starts);

// Throws SceneError unless all are finite and from 0 up, and one is above 0.
void checkWeights(const FitWeights& weights);

}  // namespace echocine::fit
