#include "compare/pose_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "core/parallel.h"
#include "core/units.h"

namespace echocine::compare {

namespace {

// Frames, cells and pieces that are looked at: enough to rank starts, and to climb.
constexpr FitStride kCoarse{5, 4, 6}, kFine{3, 2, 2};
constexpr int kUnknowns = 4;
using Unknowns = std::array<double, kUnknowns>;  // in units of kUnit

// About as much of each as changes D alike at the size of a wall: 2 mm, 2 mm, 2 degrees, 3 %.
Unknowns units() {
  return {2e-3, 2e-3, radiansFromDegrees(2), 0.03};
}

struct Candidate {
  FitPose pose;
  double value = 2;
};

class Objective {
 public:
  Objective(const ModelLoop& model, const EchoStack& real, const FitWeights& weights,
            const PoseLimits& limits)
      : model_(model), real_(real), weights_(weights), limits_(limits) {}

  int unknowns() const { return limits_.scale_free ? kUnknowns : kUnknowns - 1; }

  double operator()(const FitPose& pose, const FitStride& stride) const {
    return fitDiscrepancy(fitTerms(model_, real_, pose, stride), weights_);
  }

  FitPose moved(const FitPose& from, const Unknowns& by) const {
    const Unknowns unit = units();
    const double shift = limits_.shift * model_.far_m, turn = radiansFromDegrees(limits_.turn_deg);
    FitPose p = from;
    p.shift_x_m = std::clamp(from.shift_x_m + by[0] * unit[0], -shift, shift);
    p.shift_z_m = std::clamp(from.shift_z_m + by[1] * unit[1], -shift, shift);
    p.turn_rad = std::clamp(from.turn_rad + by[2] * unit[2], -turn, turn);
    p.scale = std::clamp(from.scale + by[3] * unit[3], 1 - limits_.scale, 1 + limits_.scale);
    return p;
  }

  bool atLimit(const FitPose& p) const {
    constexpr double kNear = 0.999;
    return std::abs(p.shift_x_m) > kNear * limits_.shift * model_.far_m ||
           std::abs(p.shift_z_m) > kNear * limits_.shift * model_.far_m ||
           std::abs(p.turn_rad) > kNear * radiansFromDegrees(limits_.turn_deg) ||
           (limits_.scale_free && std::abs(p.scale - 1) > kNear * limits_.scale);
  }

  std::vector<Candidate> lattice() const {
    constexpr int kShifts = 4, kTurns = 2;  // each way
    const int scales = limits_.scale_free ? 2 : 0;
    std::vector<Candidate> all;
    for (int s = -scales; s <= scales; ++s)
      for (int r = -kTurns; r <= kTurns; ++r)
        for (int z = -kShifts; z <= kShifts; ++z)
          for (int x = -kShifts; x <= kShifts; ++x)
            all.push_back({{limits_.shift * model_.far_m * x / kShifts,
                            limits_.shift * model_.far_m * z / kShifts,
                            radiansFromDegrees(limits_.turn_deg) * r / kTurns,
                            1 + limits_.scale * s / std::max(1, scales)}});
    parallelBlocks(all.size(), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) all[i].value = (*this)(all[i].pose, kCoarse);
    });
    return all;
  }

 private:
  const ModelLoop& model_;
  const EchoStack& real_;
  const FitWeights& weights_;
  const PoseLimits& limits_;
};

// Gradient and Hessian by central differences of one unit, in units.
struct Local {
  cv::Mat gradient, hessian;
};
Local differences(const Objective& f, const Candidate& at, const FitStride& stride, double step) {
  const int n = f.unknowns();
  Local out{cv::Mat::zeros(n, 1, CV_64F), cv::Mat::zeros(n, n, CV_64F)};
  std::array<double, kUnknowns> plus{}, minus{};
  const auto value = [&](int i, double a, int j, double b) {
    Unknowns by{};
    by[static_cast<std::size_t>(i)] += a;
    by[static_cast<std::size_t>(j)] += b;
    return f(f.moved(at.pose, by), stride);
  };
  for (int i = 0; i < n; ++i) {
    const auto u = static_cast<std::size_t>(i);
    plus[u] = value(i, step, i, 0);
    minus[u] = value(i, -step, i, 0);
    out.gradient.at<double>(i) = (plus[u] - minus[u]) / (2 * step);
    out.hessian.at<double>(i, i) = (plus[u] - 2 * at.value + minus[u]) / (step * step);
  }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) {
      const auto u = static_cast<std::size_t>(i), v = static_cast<std::size_t>(j);
      const double both = value(i, step, j, step);
      out.hessian.at<double>(i, j) = out.hessian.at<double>(j, i) =
          (both - plus[u] - plus[v] + at.value) / (step * step);
    }
  return out;
}

// Newton's step with all curvatures made positive, no longer than three units.
Unknowns newtonStep(const Local& local) {
  cv::Mat values, vectors;
  cv::eigen(local.hessian, values, vectors);
  const double largest =
      std::max(std::abs(values.at<double>(0)), std::abs(values.at<double>(values.rows - 1)));
  const double least = std::max(1e-3 * largest, 1e-9);
  cv::Mat step = cv::Mat::zeros(local.gradient.rows, 1, CV_64F);
  for (int i = 0; i < values.rows; ++i) {
    const double along = vectors.row(i).dot(local.gradient.t());
    step -= (along / std::max(std::abs(values.at<double>(i)), least)) * vectors.row(i).t();
  }
  constexpr double kLongest = 3;
  const double length = cv::norm(step);
  if (length > kLongest) step *= kLongest / length;
  Unknowns out{};
  for (int i = 0; i < step.rows; ++i) out[static_cast<std::size_t>(i)] = step.at<double>(i);
  return out;
}

Candidate climbed(const Objective& f, const FitPose& start, const FitStride& stride) {
  Candidate best{start, f(start, stride)};
  double width = 1;  // of the differences
  for (int iteration = 0; iteration < 12; ++iteration) {
    const Unknowns step = newtonStep(differences(f, best, stride, width));
    bool better = false;
    double length = 0;
    for (double share = 1; share > 0.1 && !better; share /= 2) {
      Unknowns by = step;
      for (double& b : by) b *= share;
      const FitPose pose = f.moved(best.pose, by);
      const double value = f(pose, stride);
      if (value < best.value) {
        better = true;
        best = {pose, value};
        length = std::sqrt(by[0] * by[0] + by[1] * by[1] + by[2] * by[2] + by[3] * by[3]);
      }
    }
    // A hundredth of a unit is 20 micrometres.
    if (!better && width < 0.3) break;
    if (!better || length < 0.3) width = std::max(0.25, width / 2);
    if (better && length < 0.01 && width <= 0.25) break;
  }
  return best;
}

// 10 mm or 10 degrees apart.
bool apart(const FitPose& a, const FitPose& b) {
  return std::hypot(a.shift_x_m - b.shift_x_m, a.shift_z_m - b.shift_z_m) > 10e-3 ||
         std::abs(a.turn_rad - b.turn_rad) > radiansFromDegrees(10);
}

PoseFound finished(const Objective& f, const ModelLoop& model, const EchoStack& real,
                   const FitWeights& weights, std::vector<Candidate> climbs) {
  std::stable_sort(climbs.begin(), climbs.end(),
                   [](const Candidate& a, const Candidate& b) { return a.value < b.value; });
  PoseFound out;
  out.pose = climbs.front().pose;
  out.terms = fitTerms(model, real, out.pose);
  out.discrepancy = fitDiscrepancy(out.terms, weights);
  out.at_limit = f.atLimit(out.pose);
  for (const Candidate& c : climbs) {
    bool other = apart(c.pose, out.pose);
    for (const auto& [pose, value] : out.rivals) other = other && apart(c.pose, pose);
    if (other) out.rivals.emplace_back(c.pose, c.value);
  }
  return out;
}

}  // namespace

PoseFound refinePose(const ModelLoop& model, const EchoStack& real, const FitWeights& weights,
                     const PoseLimits& limits, const std::vector<FitPose>& starts) {
  const Objective f(model, real, weights, limits);
  std::vector<Candidate> climbs(starts.size());
  parallelBlocks(climbs.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) climbs[i] = climbed(f, starts[i], kFine);
  });
  return finished(f, model, real, weights, climbs);
}

PoseFound searchPose(const ModelLoop& model, const EchoStack& real, const FitWeights& weights,
                     const PoseLimits& limits) {
  const Objective f(model, real, weights, limits);
  std::vector<Candidate> all = f.lattice();
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.value < b.value; });
  const double median = all[all.size() / 2].value;
  // Starts that stand apart, lest all climb one hill.
  constexpr std::size_t kStarts = 5;
  std::vector<FitPose> starts;
  for (const Candidate& c : all) {
    bool other = true;
    for (const FitPose& s : starts) other = other && apart(c.pose, s);
    if (other) starts.push_back(c.pose);
    if (starts.size() == kStarts) break;
  }
  PoseFound out = refinePose(model, real, weights, limits, starts);
  const double next = out.rivals.empty() ? median : out.rivals.front().second;
  const double best = f(out.pose, kFine);
  out.confidence = median > best ? std::clamp((next - best) / (median - best), 0.0, 1.0) : 0;
  return out;
}

}  // namespace echocine::compare
