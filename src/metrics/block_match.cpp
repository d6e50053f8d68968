#include "metrics/block_match.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"

namespace echocine {

namespace {

// A block's values about their mean are what a correlation compares.
struct Block {
  const BlockPlane& plane;
  int line, sample, half_lines, half_samples;

  bool within() const {
    return line >= half_lines && line + half_lines < plane.lines && sample >= half_samples &&
           sample + half_samples < plane.samples;
  }
  const float* row(int i) const {
    return plane.values.data() + static_cast<std::ptrdiff_t>(line + i) * plane.samples +
           (sample - half_samples);
  }
  int width() const { return 2 * half_samples + 1; }
  double mean() const {
    double sum = 0;
    for (int i = -half_lines; i <= half_lines; ++i)
      for (int k = 0; k < width(); ++k) sum += static_cast<double>(row(i)[k]);
    return sum / ((2 * half_lines + 1) * width());
  }
};

// Sum of products of two blocks of one size, about their means.
double product(const Block& a, double mean_a, const Block& b, double mean_b) {
  double sum = 0;
  for (int i = -a.half_lines; i <= a.half_lines; ++i) {
    const float *x = a.row(i), *y = b.row(i);
    for (int k = 0; k < a.width(); ++k)
      sum += (static_cast<double>(x[k]) - mean_a) * (static_cast<double>(y[k]) - mean_b);
  }
  return sum;
}

class Search {
 public:
  Search(const BlockPlane& after, const Block& block)
      : after_(after),
        block_(block),
        mean_(block.mean()),
        power_(product(block, mean_, block, mean_)) {}

  // Smaller than any correlation where the shifted block does not lie in the picture, or is even.
  double at(int lines, int samples) const {
    const Block moved{after_, block_.line + lines, block_.sample + samples, block_.half_lines,
                      block_.half_samples};
    if (!moved.within()) return kNone;
    const double mean = moved.mean(), power = product(moved, mean, moved, mean);
    return power > 0 ? product(block_, mean_, moved, mean) / std::sqrt(power_ * power) : kNone;
  }
  bool even() const { return !(power_ > 0); }

  static constexpr double kNone = -2;

 private:
  const BlockPlane& after_;
  const Block& block_;
  double mean_, power_;
};

// The least-squares paraboloid through 3 x 3 correlations c[line][sample] about the greatest.
struct Paraboloid {
  double line = 0, sample = 0, line2 = 0, sample2 = 0, both = 0;  // its coefficients

  explicit Paraboloid(const double (&c)[3][3]) {
    for (int i = -1; i <= 1; ++i)
      for (int k = -1; k <= 1; ++k) {
        const double f = c[i + 1][k + 1];
        line += i * f / 6;
        sample += k * f / 6;
        both += i * k * f / 4;
        line2 += (i == 0 ? -2 : 1) * f / 6;
        sample2 += (k == 0 ? -2 : 1) * f / 6;
      }
  }
  // Its top, held within the 3 x 3; the middle where it has none.
  void addTop(BlockMatch& match) const {
    const double det = 4 * line2 * sample2 - both * both;
    if (!(det > 0 && line2 < 0)) return;
    match.lines += std::clamp((both * sample - 2 * sample2 * line) / det, -1.0, 1.0);
    match.samples += std::clamp((both * line - 2 * line2 * sample) / det, -1.0, 1.0);
  }
};

}  // namespace

std::optional<BlockMatch> matchBlock(const BlockPlane& before, const BlockPlane& after, int line,
                                     int sample, const BlockMatchSettings& s) {
  CHECK_EQ(before.lines, after.lines);
  CHECK_EQ(before.samples, after.samples);
  const Block block{before, line, sample, s.half_lines, s.half_samples};
  if (!block.within()) return std::nullopt;
  const Search search(after, block);
  if (search.even()) return std::nullopt;
  int best_lines = 0, best_samples = 0;
  double best = Search::kNone;
  for (int i = -s.search_lines; i <= s.search_lines; ++i)
    for (int k = -s.search_samples; k <= s.search_samples; ++k) {
      const double found = search.at(i, k);
      if (found <= best) continue;
      best = found;
      best_lines = i;
      best_samples = k;
    }
  if (std::abs(best_lines) == s.search_lines || std::abs(best_samples) == s.search_samples)
    return std::nullopt;
  double about[3][3];
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      about[i][k] = search.at(best_lines + i - 1, best_samples + k - 1);
      if (about[i][k] == Search::kNone) return std::nullopt;
    }
  BlockMatch match{.lines = static_cast<double>(best_lines),
                   .samples = static_cast<double>(best_samples),
                   .correlation = best};
  Paraboloid(about).addTop(match);
  return match;
}

std::optional<double> correlationInPlace(const BlockPlane& before, const BlockPlane& after,
                                         int line, int sample, const BlockMatchSettings& s) {
  const Block block{before, line, sample, s.half_lines, s.half_samples};
  if (!block.within()) return std::nullopt;
  const Search search(after, block);
  const double found = search.even() ? Search::kNone : search.at(0, 0);
  return found == Search::kNone ? std::nullopt : std::optional(found);
}

}  // namespace echocine
