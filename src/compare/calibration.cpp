#include "compare/calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>

#include "core/check.h"
#include "core/error.h"

namespace echocine::compare {

namespace {

// Which two hats a grey lies under, and the weight of the right one.
// Hats: the linear functions that are 1 on their own knot and 0 on all others.
struct Place {
  std::size_t left;
  double right_share;
};

Place placeOf(const std::vector<double>& knots, double grey) {
  if (!(grey > knots.front())) return {0, 0};
  if (!(grey < knots.back())) return {knots.size() - 2, 1};
  const auto above = std::upper_bound(knots.begin(), knots.end(), grey);
  const auto i = static_cast<std::size_t>(above - knots.begin()) - 1;
  return {i, (grey - knots[i]) / (knots[i + 1] - knots[i])};
}

// Least squares for the unknowns in `free`, all others 0.
std::vector<double> solveFor(const cv::Mat& a, const cv::Mat& b, const std::vector<int>& free) {
  const int n = static_cast<int>(free.size());
  cv::Mat sub(n, n, CV_64F), right(n, 1, CV_64F), x;
  for (int i = 0; i < n; ++i) {
    right.at<double>(i) = b.at<double>(free[static_cast<std::size_t>(i)]);
    for (int j = 0; j < n; ++j)
      sub.at<double>(i, j) =
          a.at<double>(free[static_cast<std::size_t>(i)], free[static_cast<std::size_t>(j)]);
  }
  if (!cv::solve(sub, right, x, cv::DECOMP_SVD) || !cv::checkRange(x))
    throw JobError("the grey calibration has no solution; give other --knots");
  std::vector<double> all(static_cast<std::size_t>(b.rows), 0);
  for (int i = 0; i < n; ++i)
    all[static_cast<std::size_t>(free[static_cast<std::size_t>(i)])] = x.at<double>(i);
  return all;
}

// Lawson and Hanson, "Solving Least Squares Problems", 1974, ch. 23 (NNLS), on normal equations.
// The first unknown may have any sign.
std::vector<double> nonNegative(const cv::Mat& a, const cv::Mat& b) {
  const int n = b.rows;
  std::vector<int> free{0};
  std::vector<double> x = solveFor(a, b, free);
  const double scale = cv::norm(b, cv::NORM_INF);
  for (int round = 0; round < 3 * n; ++round) {
    // The unknown at 0 whose release lowers the error fastest; none left to gain from ends the
    // search.
    int enter = -1;
    double steepest = 1e-12 * scale;
    for (int i = 1; i < n; ++i) {
      if (std::find(free.begin(), free.end(), i) != free.end()) continue;
      double slope = b.at<double>(i);
      for (int j = 0; j < n; ++j) slope -= a.at<double>(i, j) * x[static_cast<std::size_t>(j)];
      if (slope > steepest) steepest = slope, enter = i;
    }
    if (enter < 0) break;
    free.push_back(enter);
    for (;;) {
      const std::vector<double> wanted = solveFor(a, b, free);
      double step = 1;
      for (const int i : free) {
        const auto at = static_cast<std::size_t>(i);
        if (i > 0 && wanted[at] <= 0) step = std::min(step, x[at] / (x[at] - wanted[at]));
      }
      if (step >= 1) {
        x = wanted;
        break;
      }
      for (std::size_t i = 0; i < x.size(); ++i) x[i] += step * (wanted[i] - x[i]);
      std::erase_if(free, [&](int i) { return i > 0 && x[static_cast<std::size_t>(i)] <= 1e-12; });
    }
  }
  return x;
}

}  // namespace

double GreyCurve::operator()(double grey) const {
  if (knots.empty()) return grey;
  const Place p = placeOf(knots, grey);
  return (1 - p.right_share) * values[p.left] + p.right_share * values[p.left + 1];
}

void GreyCurve::apply(std::span<const float> in, std::span<float> out) const {
  if (knots.empty()) {
    std::copy(in.begin(), in.end(), out.begin());
    return;
  }
  // A table of 4096 greys: its own error stays under a hundredth of a grey between knots, and it is
  // ten times quicker than searching.
  constexpr int kSteps = 4096;
  std::array<float, kSteps + 2> table{};
  for (int i = 0; i < kSteps + 2; ++i)
    table[static_cast<std::size_t>(i)] = static_cast<float>((*this)(255.0 * i / kSteps));
  for (std::size_t i = 0; i < in.size(); ++i) {
    const float at = std::clamp(in[i], 0.0f, 255.0f) * (kSteps / 255.0f);
    const auto cell = static_cast<std::size_t>(at);
    const float share = at - static_cast<float>(cell);
    out[i] = (1 - share) * table[cell] + share * table[cell + 1];
  }
}

CalibrationFit::CalibrationFit(std::vector<double> knots) : knots_(std::move(knots)) {
  CHECK_LE(std::size_t{2}, knots_.size());
  normal_.assign(knots_.size() * knots_.size(), 0);
  right_.assign(knots_.size(), 0);
}

void CalibrationFit::add(std::span<const float> synthetic, std::span<const float> real,
                         std::span<const float> weights) {
  const std::size_t n = knots_.size();
  for (std::size_t i = 0; i < synthetic.size(); ++i) {
    const double w = weights[i];
    if (!(w > 0)) continue;
    const Place p = placeOf(knots_, synthetic[i]);
    const double r = p.right_share, l = 1 - r, y = real[i];
    // A sample lies under two hats, so it fills four places of the normal equations.
    double* row = normal_.data() + p.left * n + p.left;
    row[0] += w * l * l;
    row[1] += w * l * r;
    row[n] += w * l * r;
    row[n + 1] += w * r * r;
    right_[p.left] += w * l * y;
    right_[p.left + 1] += w * r * y;
  }
}

GreyCurve CalibrationFit::solve(bool monotone) const {
  const int n = static_cast<int>(knots_.size());
  cv::Mat a(n, n, CV_64F, const_cast<double*>(normal_.data()));
  cv::Mat b(n, 1, CV_64F, const_cast<double*>(right_.data()));
  cv::Mat normal = a.clone(), right = b.clone();
  // A hat that no sample falls under takes its neighbours' mean: second differences, with a weight
  // that fitted hats do not feel.
  const double faint = 1e-9 * cv::trace(normal)[0] + 1e-30;
  for (int i = 1; i + 1 < n; ++i) {
    const int at[3] = {i - 1, i, i + 1};
    const double d[3] = {1, -2, 1};
    for (int p = 0; p < 3; ++p)
      for (int q = 0; q < 3; ++q) normal.at<double>(at[p], at[q]) += faint * d[p] * d[q];
  }
  GreyCurve curve{knots_, {}};
  if (!monotone) {
    cv::Mat x;
    if (!cv::solve(normal, right, x, cv::DECOMP_SVD) || !cv::checkRange(x))
      throw JobError("the grey calibration has no solution; give other --knots");
    for (int i = 0; i < n; ++i) curve.values.push_back(x.at<double>(i));
    return curve;
  }
  // values = S increments with S lower triangular ones.
  cv::Mat sums = cv::Mat::zeros(n, n, CV_64F);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j <= i; ++j) sums.at<double>(i, j) = 1;
  const std::vector<double> steps = nonNegative(sums.t() * normal * sums, sums.t() * right);
  double value = 0;
  for (const double step : steps) curve.values.push_back(value += step);
  return curve;
}

// Knots at the quantiles of the greys: without samples a curve is undetermined.
std::vector<double> quantileKnots(std::span<const std::vector<float>* const> frames,
                                  std::span<const float> weights, int count) {
  constexpr int kBins = 1024;
  std::vector<double> bins(kBins, 0);
  double total = 0, lowest = 255, highest = 0;
  for (const std::vector<float>* frame : frames)
    for (std::size_t i = 0; i < frame->size(); ++i) {
      if (!(weights[i] > 0)) continue;
      const double grey = (*frame)[i];
      bins[static_cast<std::size_t>(std::clamp(grey / 255 * (kBins - 1), 0.0, kBins - 1.0))] +=
          weights[i];
      total += weights[i];
      lowest = std::min(lowest, grey);
      highest = std::max(highest, grey);
    }
  std::vector<double> knots{lowest};
  double sum = 0;
  int next = 1;
  for (int i = 0; i < kBins && next < count - 1; ++i) {
    sum += bins[static_cast<std::size_t>(i)];
    while (next < count - 1 && sum >= total * next / (count - 1)) {
      const double grey = 255.0 * i / (kBins - 1);
      // Knots under a grey apart would fit noise.
      if (grey > knots.back() + 1 && grey < highest - 1) knots.push_back(grey);
      ++next;
    }
  }
  knots.push_back(std::max(highest, lowest + 1));
  return knots;
}

}  // namespace echocine::compare
