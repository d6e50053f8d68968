#include "metrics/picture_error.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "metrics/structural_similarity.h"

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

double structuralSimilarity(const GreyImage& a, const GreyImage& b, std::span<const float> sector) {
  CHECK_EQ(a.pixels.size(), sector.size());
  const std::vector<float> x(a.pixels.begin(), a.pixels.end()), y(b.pixels.begin(), b.pixels.end());
  std::vector<float> weights(sector.size());
  for (std::size_t i = 0; i < weights.size(); ++i) weights[i] = sector[i] < 0 ? 0.0f : 1.0f;
  return structuralSimilarity(x, y, {}, weights, a.height, a.width).value_or(1);
}

}  // namespace echocine
