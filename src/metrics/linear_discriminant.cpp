#include "metrics/linear_discriminant.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace echocine {

namespace {

constexpr double kShrink = 0.1;

// Adds half the covariance of a class.
void addWithin(std::span<const FeatureRow> rows, const FeatureRow& mean, cv::Mat& within) {
  const double share = 0.5 / static_cast<double>(rows.size());
  const int n = within.rows;
  for (const FeatureRow& row : rows)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const auto u = static_cast<std::size_t>(i), v = static_cast<std::size_t>(j);
        within.at<double>(i, j) += share * (row[u] - mean[u]) * (row[v] - mean[v]);
      }
}

}  // namespace

FeatureRow meanOf(std::span<const FeatureRow> rows) {
  FeatureRow mean(rows.front().size());
  for (const FeatureRow& row : rows)
    for (std::size_t i = 0; i < row.size(); ++i)
      mean[i] += row[i] / static_cast<double>(rows.size());
  return mean;
}

LinearDiscriminant::LinearDiscriminant(std::span<const FeatureRow> a,
                                       std::span<const FeatureRow> b) {
  const FeatureRow mean_a = meanOf(a), mean_b = meanOf(b);
  const auto n = static_cast<int>(mean_a.size());
  cv::Mat within = cv::Mat::zeros(n, n, CV_64F), apart(n, 1, CV_64F), weights;
  addWithin(a, mean_a, within);
  addWithin(b, mean_b, within);
  for (int i = 0; i < n; ++i) scale_.push_back(std::sqrt(within.at<double>(i, i)) + 1e-12);
  for (int i = 0; i < n; ++i) {
    const auto u = static_cast<std::size_t>(i);
    apart.at<double>(i, 0) = (mean_a[u] - mean_b[u]) / scale_[u];
    for (int j = 0; j < n; ++j)
      within.at<double>(i, j) =
          within.at<double>(i, j) / (scale_[u] * scale_[static_cast<std::size_t>(j)]) +
          (i == j ? kShrink : 0);
  }
  cv::solve(within, apart, weights, cv::DECOMP_CHOLESKY);
  for (int i = 0; i < n; ++i) weights_.push_back(weights.at<double>(i, 0));
}

double LinearDiscriminant::of(const FeatureRow& row) const {
  double sum = 0;
  for (std::size_t i = 0; i < row.size(); ++i) sum += weights_[i] * row[i] / scale_[i];
  return sum;
}

double areaUnderCurve(std::span<const double> a, std::span<const double> b) {
  std::vector<double> sorted(b.begin(), b.end());
  std::sort(sorted.begin(), sorted.end());
  double in_order = 0;
  for (const double x : a) {
    const auto [low, high] = std::equal_range(sorted.begin(), sorted.end(), x);
    in_order += static_cast<double>(low - sorted.begin()) + 0.5 * static_cast<double>(high - low);
  }
  return in_order / (static_cast<double>(a.size()) * static_cast<double>(b.size()));
}

}  // namespace echocine
