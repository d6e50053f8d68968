#include "dataset/shrink.h"

#include <algorithm>
#include <cmath>

namespace echocine::dataset {

namespace {

// Pixels along one axis that a small pixel covers, and how much of each.
struct Cover {
  int first = 0;
  std::vector<float> shares;  // sum to 1
};

std::vector<Cover> covers(double begin, double side, int to, int most) {
  std::vector<Cover> all(static_cast<std::size_t>(to));
  for (int i = 0; i < to; ++i) {
    const double low = begin + side * i / to, high = begin + side * (i + 1) / to;
    Cover& cover = all[static_cast<std::size_t>(i)];
    cover.first = static_cast<int>(std::floor(low));
    for (int p = cover.first; p < high && p < most; ++p)
      cover.shares.push_back(
          static_cast<float>((std::min(p + 1.0, high) - std::max(1.0 * p, low)) / (high - low)));
  }
  return all;
}

}  // namespace

Square sectorSquare(const GreyImage& image) {
  constexpr double kMargin = 0.02;
  return {kMargin * image.height, kMargin * image.height, (1 - 2 * kMargin) * image.height};
}

GreyImage shrunk(const GreyImage& image, const Square& from, int to) {
  const std::vector<Cover> columns = covers(from.x, from.side, to, image.width),
                           rows = covers(from.y, from.side, to, image.height);
  const auto width = static_cast<std::size_t>(image.width), small = static_cast<std::size_t>(to);
  GreyImage result{to, to, std::vector<std::uint8_t>(small * small)};
  std::vector<float> line(width);
  for (std::size_t y = 0; y < small; ++y) {
    std::fill(line.begin(), line.end(), 0.0f);
    for (std::size_t k = 0; k < rows[y].shares.size(); ++k) {
      const std::uint8_t* const source =
          image.pixels.data() + (static_cast<std::size_t>(rows[y].first) + k) * width;
      for (std::size_t x = 0; x < width; ++x) line[x] += rows[y].shares[k] * source[x];
    }
    for (std::size_t x = 0; x < small; ++x) {
      float sum = 0;
      for (std::size_t k = 0; k < columns[x].shares.size(); ++k)
        sum += columns[x].shares[k] * line[static_cast<std::size_t>(columns[x].first) + k];
      result.pixels[y * small + x] = static_cast<std::uint8_t>(std::lround(std::min(sum, 255.0f)));
    }
  }
  return result;
}

PixelPoint inShrunk(PixelPoint at, const Square& from, int to) {
  return {(at.x - from.x) * to / from.side - 0.5, (at.y - from.y) * to / from.side - 0.5};
}

}  // namespace echocine::dataset
