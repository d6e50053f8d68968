#include "fit/secant_covariance.h"

#include <opencv2/core.hpp>

#include "core/check.h"

namespace echocine::fit {

namespace {

cv::Mat difference(const std::vector<double>& a, const std::vector<double>& b) {
  return cv::Mat(a, true) - cv::Mat(b, true);
}

// Empty if the step is too short, or the covariance not definite after rounding.
cv::Mat dampedChange(const cv::Mat& first, const cv::Mat& s, const cv::Mat& y) {
  using Secant = SecantCovariance;
  cv::Mat expected;
  if (!cv::solve(first, s, expected, cv::DECOMP_CHOLESKY)) return {};
  const double square = s.dot(expected), ratio = s.dot(y) / square;
  if (!(square >= Secant::kShortest * Secant::kShortest)) return {};
  if (ratio > Secant::kMostRatio) return y * (Secant::kMostRatio / ratio);
  if (ratio >= Secant::kLeastRatio) return y;
  const double share = (1 - Secant::kLeastRatio) / (1 - ratio);
  return share * y + (1 - share) * expected;
}

}  // namespace

void SecantCovariance::add(const std::vector<double>& at, const std::vector<double>& slopes) {
  const auto n = static_cast<int>(at.size());
  CHECK_EQ(covariance_.size(), at.size() * at.size());
  CHECK_EQ(slopes.size(), at.size());
  if (!at_.empty()) {
    cv::Mat c(n, n, CV_64F, covariance_.data());
    const cv::Mat s = difference(at, at_),
                  y = dampedChange({n, n, CV_64F, first_.data()}, s, difference(slopes, slopes_));
    if (!y.empty()) {
      const double sy = s.dot(y);
      const cv::Mat left = cv::Mat::eye(n, n, CV_64F) - s * y.t() / sy;
      const cv::Mat next = left * c * left.t() + s * s.t() / sy;
      cv::Mat(0.5 * (next + next.t())).copyTo(c);
    }
  }
  at_ = at;
  slopes_ = slopes;
}

}  // namespace echocine::fit
