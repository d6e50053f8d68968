#pragma once
// Where a block of one picture is found again in the next, as speckle tracking does it: the shift
// of the greatest normalised correlation, between samples by a paraboloid. Pictures are line-major
// planes of beam space, or rows of pixels.

#include <optional>
#include <span>

namespace echocine {

struct BlockMatchSettings {
  int half_lines = 8, half_samples = 16;      // the block reaches so far either side of its middle
  int search_lines = 6, search_samples = 12;  // shifts that are tried, either way
};

struct BlockMatch {
  double lines = 0, samples = 0;  // shift of the block from `before` to `after`
  double correlation = 0;         // there, at the whole shift: -1 to 1
};

// A plane of lines * samples numbers, line-major.
struct BlockPlane {
  std::span<const float> values;
  int lines = 0, samples = 0;
};

// Nothing where the block does not lie within `before`, where it is even, where no whole shift
// keeps it within `after`, or where the best shift lies at the end of those that can be tried: the
// true one may lie beyond. Preconditions: planes of equal size; finite values; settings of 1 up.
std::optional<BlockMatch> matchBlock(const BlockPlane& before, const BlockPlane& after, int line,
                                     int sample, const BlockMatchSettings& settings = {});

// The normalised correlation of a block with what is there in another picture. Nothing where the
// block does not lie within the pictures or is even in one of them. Preconditions: as above.
std::optional<double> correlationInPlace(const BlockPlane& before, const BlockPlane& after,
                                         int line, int sample, const BlockMatchSettings& settings);

}  // namespace echocine
