#pragma once
// Means over boxes of a picture within a mask, by summed-area tables.

#include <cstdint>
#include <span>
#include <vector>

namespace echocine {

class BoxMeans {
 public:
  // mask: 0 excludes a pixel; sizes width times height.
  BoxMeans(int width, int height, std::span<const float> values,
           std::span<const std::uint8_t> mask);

  // Over +-half_x by +-half_y pixels around (x, y), cut at the picture's edges.
  struct Sums {
    double count = 0, sum = 0, squares = 0;
    double mean() const { return sum / count; }
    double deviation() const;
  };
  Sums at(int x, int y, int half_x, int half_y) const;

  // The mask's fraction of the whole box, also at the picture's edges.
  double share(int x, int y, int half_x, int half_y) const;

  // Means at all pixels of the mask; NaN if it fills less than `least` of the box.
  std::vector<float> means(int half_x, int half_y, double least) const;

 private:
  struct Corner {
    double count = 0, sum = 0, squares = 0;
  };
  int width_, height_;
  std::vector<std::uint8_t> mask_;
  std::vector<Corner> table_;  // (width + 1) times (height + 1)
};

}  // namespace echocine
