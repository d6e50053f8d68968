#include "metrics/structural_similarity.h"

#include <opencv2/imgproc.hpp>

#include "core/check.h"

namespace echocine {

namespace {

cv::Mat plane(std::span<const float> values, int rows, int columns) {
  // OpenCV takes no pointer to const; nothing is written through it.
  return cv::Mat(rows, columns, CV_32F, const_cast<float*>(values.data()));
}

cv::Mat windowSum(const cv::Mat& values) {
  constexpr int kWindow = 11;
  constexpr double kDeviation = 1.5;
  cv::Mat sum;
  cv::GaussianBlur(values, sum, {kWindow, kWindow}, kDeviation, kDeviation, cv::BORDER_CONSTANT);
  return sum;
}

// Greys about the middle, which cancel less in the variances; 0 outside.
constexpr double kMiddle = 127.5;
cv::Mat aboutTheMiddle(const cv::Mat& greys, const cv::Mat& mask) {
  cv::Mat out;
  greys.convertTo(out, CV_64F, 1, -kMiddle);
  return out.mul(mask);
}

}  // namespace

std::optional<double> structuralSimilarity(std::span<const float> x, std::span<const float> y,
                                           std::span<const float> inside,
                                           std::span<const float> weights, int rows, int columns) {
  CHECK_EQ(x.size(), y.size());
  CHECK_EQ(x.size(), weights.size());
  constexpr double kC1 = (0.01 * 255) * (0.01 * 255), kC2 = (0.03 * 255) * (0.03 * 255);
  cv::Mat mask(rows, columns, CV_64F, cv::Scalar(1));
  if (!inside.empty()) cv::Mat(plane(inside, rows, columns) > 0).convertTo(mask, CV_64F, 1.0 / 255);
  const cv::Mat u = aboutTheMiddle(plane(x, rows, columns), mask),
                v = aboutTheMiddle(plane(y, rows, columns), mask);
  const cv::Mat n = windowSum(mask), su = windowSum(u), sv = windowSum(v),
                suu = windowSum(u.mul(u)), svv = windowSum(v.mul(v)), suv = windowSum(u.mul(v));
  double sum = 0, total = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double w = weights[i];
    if (!(w > 0)) continue;
    const auto at = [i](const cv::Mat& m) { return m.ptr<double>()[i]; };
    const double k = at(n), mu = at(su) / k, mv = at(sv) / k;
    const double vu = at(suu) / k - mu * mu, vv = at(svv) / k - mv * mv, c = at(suv) / k - mu * mv;
    const double mx = mu + kMiddle, my = mv + kMiddle;
    sum += w * (2 * mx * my + kC1) * (2 * c + kC2) / ((mx * mx + my * my + kC1) * (vu + vv + kC2));
    total += w;
  }
  return total > 0 ? std::optional(sum / total) : std::nullopt;
}

}  // namespace echocine
