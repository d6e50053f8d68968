#include "metrics/box_means.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echocine {

BoxMeans::BoxMeans(int width, int height, std::span<const float> values,
                   std::span<const std::uint8_t> mask)
    : width_(width),
      height_(height),
      mask_(mask.begin(), mask.end()),
      table_(static_cast<std::size_t>(width + 1) * static_cast<std::size_t>(height + 1)) {
  const auto stride = static_cast<std::size_t>(width + 1);
  for (int y = 0; y < height; ++y) {
    Corner row;
    for (int x = 0; x < width; ++x) {
      const std::size_t from = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                               static_cast<std::size_t>(x);
      if (mask[from] != 0) {
        const double v = static_cast<double>(values[from]);
        row.count += 1;
        row.sum += v;
        row.squares += v * v;
      }
      const std::size_t to =
          static_cast<std::size_t>(y + 1) * stride + static_cast<std::size_t>(x + 1);
      const Corner& above = table_[to - stride];
      table_[to] = {above.count + row.count, above.sum + row.sum, above.squares + row.squares};
    }
  }
}

double BoxMeans::Sums::deviation() const {
  const double m = mean();
  return std::sqrt(std::max(squares / count - m * m, 0.0));
}

BoxMeans::Sums BoxMeans::at(int x, int y, int half_x, int half_y) const {
  const auto stride = static_cast<std::size_t>(width_ + 1);
  const auto x0 = static_cast<std::size_t>(std::max(x - half_x, 0)),
             x1 = static_cast<std::size_t>(std::min(x + half_x + 1, width_)),
             y0 = static_cast<std::size_t>(std::max(y - half_y, 0)) * stride,
             y1 = static_cast<std::size_t>(std::min(y + half_y + 1, height_)) * stride;
  const Corner &a = table_[y0 + x0], &b = table_[y0 + x1], &c = table_[y1 + x0],
               &d = table_[y1 + x1];
  return {d.count - c.count - b.count + a.count, d.sum - c.sum - b.sum + a.sum,
          d.squares - c.squares - b.squares + a.squares};
}

double BoxMeans::share(int x, int y, int half_x, int half_y) const {
  return at(x, y, half_x, half_y).count / ((2.0 * half_x + 1) * (2.0 * half_y + 1));
}

std::vector<float> BoxMeans::means(int half_x, int half_y, double least) const {
  std::vector<float> means(mask_.size(), std::numeric_limits<float>::quiet_NaN());
  std::size_t i = 0;
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x, ++i)
      if (mask_[i] != 0 && share(x, y, half_x, half_y) >= least)
        means[i] = static_cast<float>(at(x, y, half_x, half_y).mean());
  return means;
}

}  // namespace echocine
