#include "fit/dial_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/nearest_word.h"
#include "core/units.h"

namespace echocine::fit {

namespace {

// Accepted: our choice, from a small right ventricle to a dilated one.
constexpr heart::Dial kRatioDial{
    kRightRatio,
    "1",
    0.6,
    1.6,
    0,
    "end-diastolic volume of the right ventricle / of the left one",
    [](heart::Parameters& p, double value) { p.rv_edv_ml = value * p.edv_ml; },
    [](const heart::Parameters& p) { return std::optional<double>(p.rv_edv_ml / p.edv_ml); }};

}  // namespace

const heart::Dial& dialOf(const std::string& argument, const std::string& key) {
  if (key == kRatioDial.key) return kRatioDial;
  std::vector<std::string> known{kRatioDial.key};
  for (const heart::Dial& dial : heart::dials()) {
    if (key == dial.key) return dial;
    known.emplace_back(dial.key);
  }
  const std::string nearest = nearestWord(key, known);
  throw SceneError(fmt::format("{}: \"{}\" is not a dial of the heart{}, accepted: {}", argument,
                               key, nearest.empty() ? "" : fmt::format(" (nearest: {})", nearest),
                               fmt::join(known, ", ")));
}

void checkDial(const std::string& argument, const heart::Dial& dial, double value) {
  if (!(value >= dial.low && value <= dial.high))
    throw SceneError(fmt::format("{}: {} is {:g}, accepted: {:g} to {:g}{}{}", argument, dial.key,
                                 value, dial.low, dial.high,
                                 std::string(dial.unit) == "1" ? "" : " ",
                                 std::string(dial.unit) == "1" ? "" : dial.unit));
}

void checkRanges(const std::map<std::string, double>& dials, const std::vector<DialRange>& ranges) {
  for (const auto& [key, value] : dials) checkDial("dials", dialOf("dials", key), value);
  const auto has = [&](const std::string& key) {
    return dials.contains(key) || std::any_of(ranges.begin(), ranges.end(),
                                              [&](const DialRange& r) { return r.key == key; });
  };
  if (has(kRightRatio) && has("rv-edv"))
    throw SceneError(
        fmt::format("dials: rv-edv and {} are both given; leave one out", kRightRatio));
  for (auto range = ranges.begin(); range != ranges.end(); ++range) {
    const heart::Dial& dial = dialOf("ranges", range->key);
    checkDial("ranges", dial, range->low);
    checkDial("ranges", dial, range->high);
    if (!(range->low < range->high))
      throw SceneError(fmt::format("ranges: {} is {:g} to {:g}, accepted: a range that ascends",
                                   range->key, range->low, range->high));
    if (std::any_of(ranges.begin(), range,
                    [&](const DialRange& other) { return other.key == range->key; }))
      throw SceneError(fmt::format("ranges: {} is given twice", range->key));
    if (dials.contains(range->key))
      throw SceneError(fmt::format("dials: {} has a range; leave it out", range->key));
  }
}

void checkNodes(const std::vector<DialRange>& ranges, int nodes) {
  if (nodes < kLeastNodes || nodes > kMostNodes)
    throw SceneError(
        fmt::format("nodes: is {}, accepted: {} to {}", nodes, kLeastNodes, kMostNodes));
  std::size_t hearts = 1;
  for (std::size_t r = 0; r < ranges.size(); ++r)
    if ((hearts *= static_cast<std::size_t>(nodes)) > kMostHearts)
      throw SceneError(
          fmt::format("nodes: {} for each of {} ranges are more than {} hearts; take fewer", nodes,
                      ranges.size(), kMostHearts));
}

void checkValues(const std::vector<DialRange>& ranges, std::span<const double> values) {
  if (values.size() != ranges.size())
    throw SceneError(fmt::format("values: holds {} numbers, accepted: {}, one for each range",
                                 values.size(), ranges.size()));
  constexpr double kRounding = 1e-9;  // of a range: values of a grid are sums of its steps
  for (std::size_t r = 0; r < values.size(); ++r) {
    const DialRange& range = ranges[r];
    const double beyond = kRounding * (range.high - range.low);
    if (!(values[r] >= range.low - beyond && values[r] <= range.high + beyond))
      throw SceneError(fmt::format("values: {} is {:g}, accepted: {:g} to {:g}", range.key,
                                   values[r], range.low, range.high));
  }
}

namespace {

void checkNumber(const char* name, double value, double low, double high) {
  if (!(value >= low && value <= high))
    throw SceneError(
        fmt::format("pose: {} is {:g}, accepted: {:g} to {:g}", name, value, low, high));
}

}  // namespace

void checkPose(const FitPose& pose) {
  constexpr double kMostShift_mm = 1e3 * kMostShift_m;
  checkNumber("shift_x_mm", millimetresFromMetres(pose.shift_x_m), -kMostShift_mm, kMostShift_mm);
  checkNumber("shift_z_mm", millimetresFromMetres(pose.shift_z_m), -kMostShift_mm, kMostShift_mm);
  checkNumber("turn_deg", degreesFromRadians(pose.turn_rad), -180 - 1e-9, 180 + 1e-9);
  checkNumber("scale", pose.scale, kLeastScale, kMostScale);
  checkNumber("lag", pose.lag, -kMostLag, kMostLag);
  if (pose.systole != 0) checkNumber("systole", pose.systole, kEarliestSystole, kLatestSystole);
}

void checkStarts(const std::vector<FitPose>& starts) {
  if (starts.empty()) throw SceneError("starts: contains no pose, accepted: one or more");
  for (const FitPose& start : starts) {
    checkPose(start);
    if (start.lag != starts.front().lag || start.systole != starts.front().systole)
      throw SceneError("starts: have different lags or systoles, accepted: the same in all");
  }
}

void checkWeights(const FitWeights& weights) {
  const double sum = weights.region + weights.boundary + weights.motion;
  if (!(weights.region >= 0 && weights.boundary >= 0 && weights.motion >= 0 && sum > 0 &&
        std::isfinite(sum)))
    throw SceneError(
        fmt::format("weights: is {:g}, {:g}, {:g}, accepted: numbers from 0 up, one above 0",
                    weights.region, weights.boundary, weights.motion));
}

}  // namespace echocine::fit
