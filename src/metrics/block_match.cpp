#include "metrics/block_match.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/check.h"

namespace echocine {

namespace {

constexpr double kNone = -2;  // smaller than any correlation

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
};

// A block's values about their mean are what a correlation compares.
struct AboutMean {
  std::vector<double> values;  // line by line
  double power = 0;            // sum of their squares; 0: the block is constant

  explicit AboutMean(const Block& block) {
    // A constant block is exactly 0, whatever its value.
    const double first = block.row(-block.half_lines)[0];
    double sum = 0;
    for (int i = -block.half_lines; i <= block.half_lines; ++i)
      for (int k = 0; k < block.width(); ++k) {
        values.push_back(block.row(i)[k] - first);
        sum += values.back();
      }
    const double mean = sum / static_cast<double>(values.size());
    for (double& value : values) {
      value -= mean;
      power += value * value;
    }
  }
};

double correlationOf(const AboutMean& a, const AboutMean& b) {
  if (!(b.power > 0)) return kNone;
  double sum = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) sum += a.values[i] * b.values[i];
  return sum / std::sqrt(a.power * b.power);
}

// Correlations of a block with all its shifts. Shifts along the line are computed together, and
// each line's sums and sums of squares serve all shifts across lines.
class Correlations {
 public:
  // Precondition: the block is within its plane.
  Correlations(const BlockPlane& after, const Block& block, const AboutMean& about,
               const BlockMatchSettings& s)
      : after_(after), block_(block), about_(about), s_(s) {
    first_ = std::max(-s.search_samples, block.half_samples - block.sample);
    const int last =
        std::min(s.search_samples, after.samples - 1 - block.half_samples - block.sample);
    count_ = static_cast<std::size_t>(last - first_ + 1);
    stride_ = count_ + static_cast<std::size_t>(block.width()) - 1;
    top_ = std::max(0, block.line - block.half_lines - s.search_lines);
    const int end = std::min(after.lines, block.line + block.half_lines + s.search_lines + 1);
    readLines(end - top_);
    found_.assign(placeOf(s.search_lines, s.search_samples) + 1, kNone);
    dots_.resize(count_), sums_.resize(count_), squares_.resize(count_);
    for (int i = -s.search_lines; i <= s.search_lines; ++i)
      if (block.line + i - block.half_lines >= top_ && block.line + i + block.half_lines < end)
        correlate(i);
  }

  // kNone where the shifted block does not lie in the picture, or is constant.
  double at(int lines, int samples) const { return found_[placeOf(lines, samples)]; }

 private:
  std::size_t placeOf(int lines, int samples) const {
    return static_cast<std::size_t>(lines + s_.search_lines) *
               static_cast<std::size_t>(2 * s_.search_samples + 1) +
           static_cast<std::size_t>(samples + s_.search_samples);
  }

  // Numbers that the shifted blocks cover, about one of them so that little cancels.
  void readLines(int lines) {
    const auto n = static_cast<std::size_t>(lines);
    const auto middle = static_cast<std::ptrdiff_t>(block_.line) * after_.samples + block_.sample;
    const double level = after_.values[static_cast<std::size_t>(middle)];
    numbers_.resize(n * stride_);
    line_sums_.assign(n * count_, 0);
    line_squares_.assign(n * count_, 0);
    for (std::size_t r = 0; r < n; ++r) {
      const float* const from =
          after_.values.data() +
          static_cast<std::ptrdiff_t>(top_ + static_cast<int>(r)) * after_.samples +
          (block_.sample + first_ - block_.half_samples);
      double* const to = numbers_.data() + r * stride_;
      for (std::size_t k = 0; k < stride_; ++k) to[k] = from[k] - level;
      double* const sum = line_sums_.data() + r * count_;
      double* const square = line_squares_.data() + r * count_;
      for (int x = 0; x < block_.width(); ++x)
        for (std::size_t k = 0; k < count_; ++k) {
          const double number = to[static_cast<std::size_t>(x) + k];
          sum[k] += number;
          square[k] += number * number;
        }
    }
  }

  void correlate(int lines) {
    std::fill(dots_.begin(), dots_.end(), 0);
    std::fill(sums_.begin(), sums_.end(), 0);
    std::fill(squares_.begin(), squares_.end(), 0);
    const double* value = about_.values.data();
    auto r = static_cast<std::size_t>(block_.line + lines - block_.half_lines - top_);
    for (int i = -block_.half_lines; i <= block_.half_lines; ++i, ++r) {
      for (std::size_t k = 0; k < count_; ++k) {
        sums_[k] += line_sums_[r * count_ + k];
        squares_[k] += line_squares_[r * count_ + k];
      }
      const double* number = numbers_.data() + r * stride_;
      for (int x = 0; x < block_.width(); ++x, ++value, ++number)
        for (std::size_t k = 0; k < count_; ++k) dots_[k] += *value * number[k];
    }
    for (std::size_t k = 0; k < count_; ++k) {
      const int samples = first_ + static_cast<int>(k);
      const double power =
          squares_[k] - sums_[k] * sums_[k] / static_cast<double>(about_.values.size());
      // A smaller share of the squares would have lost too many digits. Our choice.
      constexpr double kLeastShare = 1e-6;
      const double found = power > kLeastShare * squares_[k]
                               ? dots_[k] / std::sqrt(about_.power * power)
                               : correlationOf(about_, AboutMean(movedBy(lines, samples)));
      found_[placeOf(lines, samples)] = found;
    }
  }

  Block movedBy(int lines, int samples) const {
    return {after_, block_.line + lines, block_.sample + samples, block_.half_lines,
            block_.half_samples};
  }

  const BlockPlane& after_;
  const Block& block_;
  const AboutMean& about_;
  const BlockMatchSettings& s_;
  int first_ = 0, top_ = 0;             // the first shift along the line; the first line
  std::size_t count_ = 0, stride_ = 0;  // of shifts along the line; of their numbers in a line
  std::vector<double> numbers_, line_sums_, line_squares_;  // line by line
  std::vector<double> dots_, sums_, squares_;               // by shift along the line
  std::vector<double> found_;                               // by shift, line by line
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
  const AboutMean values(block);
  if (!(values.power > 0)) return std::nullopt;
  const Correlations correlations(after, block, values, s);
  int best_lines = 0, best_samples = 0;
  double best = kNone;
  for (int i = -s.search_lines; i <= s.search_lines; ++i)
    for (int k = -s.search_samples; k <= s.search_samples; ++k) {
      const double found = correlations.at(i, k);
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
      about[i][k] = correlations.at(best_lines + i - 1, best_samples + k - 1);
      if (about[i][k] == kNone) return std::nullopt;
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
  const AboutMean values(block);
  if (!(values.power > 0)) return std::nullopt;
  const Block same{after, line, sample, s.half_lines, s.half_samples};
  const double found = correlationOf(values, AboutMean(same));
  return found == kNone ? std::nullopt : std::optional(found);
}

}  // namespace echocine
