#pragma once
// Block matching, as in speckle tracking: the shift of the highest normalised correlation, refined
// between samples by a paraboloid. Pictures are line-major planes of beam space, or rows of pixels.

#include <optional>
#include <span>

namespace echocine {

struct BlockMatchSettings {
  int half_lines = 8, half_samples = 16;      // half the size of the block
  int search_lines = 6, search_samples = 12;  // largest shifts, either way
};

struct BlockMatch {
  double lines = 0, samples = 0;  // shift of the block from `before` to `after`
  double correlation = 0;         // at the nearest whole shift: -1 to 1
};

// A plane of lines * samples numbers, line-major.
struct BlockPlane {
  std::span<const float> values;
  int lines = 0, samples = 0;
};

// None if the block is not within `before` or is constant, if no whole shift keeps it within
// `after`, or if the best shift is at the limit of the search: the true one may lie beyond.
// Preconditions: planes of equal size; finite values; settings of at least 1.
std::optional<BlockMatch> matchBlock(const BlockPlane& before, const BlockPlane& after, int line,
                                     int sample, const BlockMatchSettings& settings = {});

// The normalised correlation of a block with the same place in another picture. None if the block
// is not within the pictures or is constant in one of them. Preconditions: as above.
std::optional<double> correlationInPlace(const BlockPlane& before, const BlockPlane& after,
                                         int line, int sample, const BlockMatchSettings& settings);

}  // namespace echocine
