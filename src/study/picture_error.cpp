#include "study/picture_error.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/check.h"

namespace echocine {

PictureError pictureError(std::span<const float> a, std::span<const float> b,
                          double dynamic_range_db) {
  CHECK_EQ(a.size(), b.size());
  double squares = 0, largest = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i] < 0 || b[i] < 0) continue;
    const double e = std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i]));
    squares += e * e;
    largest = std::max(largest, e);
    ++count;
  }
  if (count == 0) return {};
  return {dynamic_range_db * std::sqrt(squares / static_cast<double>(count)),
          dynamic_range_db * largest};
}

namespace {

cv::Mat asDouble(const GreyImage& image) {
  // OpenCV takes no pointer to const; nothing is written through it.
  const cv::Mat bytes(image.height, image.width, CV_8UC1,
                      const_cast<std::uint8_t*>(image.pixels.data()));
  cv::Mat values;
  bytes.convertTo(values, CV_64F);
  return values;
}

cv::Mat windowMean(const cv::Mat& values) {
  constexpr int kWindow = 11;
  constexpr double kDeviation = 1.5;
  cv::Mat mean;
  cv::GaussianBlur(values, mean, cv::Size(kWindow, kWindow), kDeviation, kDeviation,
                   cv::BORDER_REFLECT);
  return mean;
}

}  // namespace

double structuralSimilarity(const GreyImage& a, const GreyImage& b, std::span<const float> sector) {
  CHECK_EQ(a.pixels.size(), b.pixels.size());
  CHECK_EQ(a.pixels.size(), sector.size());
  constexpr double kC1 = (0.01 * 255) * (0.01 * 255), kC2 = (0.03 * 255) * (0.03 * 255);
  const cv::Mat x = asDouble(a), y = asDouble(b);
  const cv::Mat mx = windowMean(x), my = windowMean(y);
  const cv::Mat xx = windowMean(x.mul(x)), yy = windowMean(y.mul(y)), xy = windowMean(x.mul(y));
  double sum = 0;
  std::size_t count = 0;
  for (int row = 0; row < a.height; ++row)
    for (int column = 0; column < a.width; ++column) {
      if (sector[static_cast<std::size_t>(row * a.width + column)] < 0) continue;
      const double m1 = mx.at<double>(row, column), m2 = my.at<double>(row, column);
      const double s1 = xx.at<double>(row, column) - m1 * m1,
                   s2 = yy.at<double>(row, column) - m2 * m2,
                   s12 = xy.at<double>(row, column) - m1 * m2;
      sum += (2 * m1 * m2 + kC1) * (2 * s12 + kC2) / ((m1 * m1 + m2 * m2 + kC1) * (s1 + s2 + kC2));
      ++count;
    }
  return count == 0 ? 1 : sum / static_cast<double>(count);
}

}  // namespace echocine
