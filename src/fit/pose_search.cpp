#include "fit/pose_search.h"

#include <algorithm>
#include <functional>

#include "core/units.h"
#include "fit/descent.h"

namespace echocine::fit {

namespace {

// Frames, cells and pieces that are looked at: enough to rank starts, and to climb.
constexpr FitStride kCoarse{5, 4, 12}, kFine{3, 2, 4};

// Of Unknowns.
constexpr double kShiftUnit_m = 2e-3, kScaleUnit = 0.03;
const double kTurnUnit_rad = radiansFromDegrees(2);

Unknowns unknownsOf(const FitPose& p) {
  return {p.shift_x_m / kShiftUnit_m, p.shift_z_m / kShiftUnit_m, p.turn_rad / kTurnUnit_rad,
          (p.scale - 1) / kScaleUnit};
}

// The time of `held`.
FitPose poseAt(const Unknowns& u, const FitPose& held) {
  return {kShiftUnit_m * u[0],
          kShiftUnit_m * u[1],
          kTurnUnit_rad * u[2],
          1 + kScaleUnit * u[3],
          held.lag,
          held.systole};
}

SearchBox boxOf(const PoseLimits& limits, double far_m) {
  SearchBox box;
  box.high =
      unknownsOf({limits.shift * far_m, limits.shift * far_m, radiansFromDegrees(limits.turn_deg),
                  limits.scale_free ? 1 + limits.scale : 1.0});
  for (std::size_t u = 0; u < kUnknowns; ++u) box.low[u] = -box.high[u];
  return box;
}

// D at the poses of unknowns, all of one time.
class DiscrepancyAt {
 public:
  DiscrepancyAt(const ModelLoop& model, const echo::EchoStack& real, const FitWeights& weights,
                const FitPose& held, const FitStride& stride)
      : weights_(weights), held_(held), beat_(model, real, held, stride) {
    beat_.blend();
  }

  std::vector<double> operator()(std::span<const Unknowns> places) const {
    std::vector<FitPose> poses;
    for (const Unknowns& u : places) poses.push_back(poseAt(u, held_));
    std::vector<double> values;
    for (const FitTerms& terms : beat_.terms(poses))
      values.push_back(fitDiscrepancy(terms, weights_));
    return values;
  }

 private:
  FitWeights weights_;
  FitPose held_;
  PlacedBeat beat_;
};

}  // namespace

PoseFound refinePose(const ModelLoop& model, const echo::EchoStack& real, const FitWeights& weights,
                     const PoseLimits& limits, const std::vector<FitPose>& starts) {
  const SearchBox box = boxOf(limits, model.far_m);
  const FitPose held = starts.front();
  std::vector<Descent> from;
  for (const FitPose& start : starts) from.push_back({box.clamped(unknownsOf(start))});
  const DiscrepancyAt fine(model, real, weights, held, kFine);
  const std::vector<Descent> hills =
      leastApart(descendAll(std::cref(fine), from, box), from.size());
  PoseFound out;
  out.pose = poseAt(hills.front().at, held);
  out.terms = fitTerms(model, real, out.pose);
  out.discrepancy = fitDiscrepancy(out.terms, weights);
  out.at_limit = box.atLimit(hills.front().at);
  for (std::size_t i = 1; i < hills.size(); ++i)
    out.rivals.emplace_back(poseAt(hills[i].at, held), hills[i].value);
  return out;
}

namespace {

// The lower one, with the optima of the other that stand apart from it among its rivals.
// `fine`: the discrepancy of rivals.
PoseFound lowerOf(PoseFound found, PoseFound other,
                  const std::function<double(const FitPose&)>& fine) {
  if (other.discrepancy < found.discrepancy) std::swap(found, other);
  std::vector<std::pair<FitPose, double>> all = std::move(found.rivals);
  all.emplace_back(other.pose, fine(other.pose));
  all.insert(all.end(), other.rivals.begin(), other.rivals.end());
  std::stable_sort(all.begin(), all.end(),
                   [](const auto& a, const auto& b) { return a.second < b.second; });
  found.rivals.clear();
  for (const auto& rival : all) {
    const Unknowns at = unknownsOf(rival.first);
    if (standApart(unknownsOf(found.pose), at) &&
        std::all_of(found.rivals.begin(), found.rivals.end(),
                    [&](const auto& kept) { return standApart(unknownsOf(kept.first), at); }))
      found.rivals.push_back(rival);
  }
  return found;
}

}  // namespace

PoseFound searchPose(const ModelLoop& model, const echo::EchoStack& real, const FitWeights& weights,
                     const PoseLimits& limits, const std::vector<FitPose>& also) {
  const DiscrepancyAt coarse(model, real, weights, {}, kCoarse);
  std::vector<Descent> all = lattice(std::cref(coarse), boxOf(limits, model.far_m), {4, 4, 2, 2});
  constexpr std::size_t kStarts = 5;
  std::vector<FitPose> starts;
  for (const Descent& d : leastApart(all, kStarts)) starts.push_back(poseAt(d.at, {}));
  std::nth_element(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2),
                   all.end(), [](const Descent& a, const Descent& b) { return a.value < b.value; });
  const double median = all[all.size() / 2].value;
  const auto fine = [&](const FitPose& pose) {
    return fitDiscrepancy(fitTerms(model, real, pose, kFine), weights);
  };
  PoseFound out = refinePose(model, real, weights, limits, starts);
  if (!also.empty())
    out = lowerOf(std::move(out), refinePose(model, real, weights, limits, also), fine);
  const double next = out.rivals.empty() ? median : out.rivals.front().second;
  out.confidence = confidenceOf(fine(out.pose), next, median);
  return out;
}

}  // namespace echocine::fit
