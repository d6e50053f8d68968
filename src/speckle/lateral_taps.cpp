#include "speckle/lateral_taps.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace echocine {

namespace {

// Where taps change along the line, they are fitted at so many widths and interpolated.
constexpr int kFits = 48;
constexpr std::ptrdiff_t kSumChains = 4, kSumStep = 2 * kSumChains;  // samples

double widest(std::span<const double> deviations) {
  return *std::max_element(deviations.begin(), deviations.end());
}

Floats4 tapOf(const std::vector<double>& taps, std::size_t m) {
  const double h = taps[m], next = m + 1 < taps.size() ? taps[m + 1] : 0;
  const auto amplitude = static_cast<float>(h);
  return Floats4{amplitude, amplitude, static_cast<float>(h * h), static_cast<float>(h * next)};
}

}  // namespace

LateralTaps::LateralTaps(const SplatGrid& grid, int samples)
    : period_lines_(grid.across().coarser),
      period_rows_(grid.across().finer),
      even_(grid.even()),
      samples_((samples + kSumStep - 1) / kSumStep * kSumStep),
      range_(
          tapRange(widest(grid.deviations()), 0, grid.across().nodes(grid.across().coarser - 1))),
      pieces_(even_ ? 1 : static_cast<std::size_t>((samples_ + kPiece - 1) / kPiece)) {
  for (int line = 0; line < period_lines_; ++line)
    even_ ? fitEven(widest(grid.deviations()), grid.across().nodes(line))
          : fitPieces(grid.deviations(), grid.across().nodes(line));
}

void LateralTaps::fitEven(double deviation, double phase) {
  const TapRange range = tapRange(deviation, phase, phase);
  phases_.push_back({range, even_taps_.size()});
  const std::vector<double> taps = amplitudeTaps(deviation, phase, range);
  for (std::size_t m = 0; m < taps.size(); ++m) {
    const Floats4 tap = tapOf(taps, m);
    CacheLine line{};
    std::memcpy(line.floats, &tap, sizeof tap);
    std::memcpy(line.floats + kNodeFloats, &tap, sizeof tap);
    even_taps_.push_back(line);
  }
}

namespace {

// Taps by width, in equal steps from the least to the most, and between two of them.
class TapFits {
 public:
  TapFits(const std::vector<double>& deviations, double phase) {
    const auto [least, most] = std::minmax_element(deviations.begin(), deviations.end());
    least_ = *least;
    per_width_ = (kFits - 1) / (*most - *least);
    for (int i = 0; i < kFits; ++i) {
      const double width = *least + (*most - *least) * i / (kFits - 1);
      ranges_.push_back(tapRange(width, phase, phase));
      fits_.push_back(amplitudeTaps(width, phase, ranges_.back()));
    }
  }

  // Those of a deviation within a range, 0 beyond their own.
  void between(double deviation, TapRange range, std::vector<double>& taps) const {
    const double at = (deviation - least_) * per_width_;
    const auto below = std::min(static_cast<std::size_t>(at), std::size_t{kFits - 2});
    const double part = at - static_cast<double>(below);
    taps.assign(static_cast<std::size_t>(range.count), 0.0);
    add(below, 1 - part, range, taps);
    add(below + 1, part, range, taps);
  }

 private:
  void add(std::size_t fit, double weight, TapRange range, std::vector<double>& taps) const {
    const int before = ranges_[fit].first - range.first;
    for (int m = std::max(before, 0); m < std::min(before + ranges_[fit].count, range.count); ++m)
      taps[static_cast<std::size_t>(m)] +=
          weight * fits_[fit][static_cast<std::size_t>(m - before)];
  }

  double least_ = 0, per_width_ = 0;
  std::vector<TapRange> ranges_;
  std::vector<std::vector<double>> fits_;
};

}  // namespace

void LateralTaps::fitPieces(const std::vector<double>& deviations, double phase) {
  const TapFits fits(deviations, phase);
  std::vector<double> taps;
  constexpr auto kSamples = static_cast<std::size_t>(kPiece);
  for (std::size_t from = 0; from < deviations.size(); from += kSamples) {
    const auto piece =
        std::span(deviations).subspan(from, std::min(kSamples, deviations.size() - from));
    const TapRange range = tapRange(widest(piece), phase, phase);
    const std::size_t first = taps_.size();
    phases_.push_back({range, first});
    taps_.resize(first + static_cast<std::size_t>(range.count) * kSamples);
    for (std::size_t k = 0; k < kSamples; ++k) {
      fits.between(piece[std::min(k, piece.size() - 1)], range, taps);
      for (std::size_t m = 0; m < taps.size(); ++m)
        taps_[first + m * kSamples + k] = tapOf(taps, m);
    }
  }
}

namespace {

// In the order of samples, from two samples each: real, imaginary, P, Q, and again.
void storeSums(const Floats8 (&pairs)[kSumChains], std::ptrdiff_t k, const LineSums& to) {
  const auto low = [](Floats8 a, Floats8 b) {
    return __builtin_shufflevector(a, b, 0, 8, 1, 9, 4, 12, 5, 13);
  };
  const auto high = [](Floats8 a, Floats8 b) {
    return __builtin_shufflevector(a, b, 2, 10, 3, 11, 6, 14, 7, 15);
  };
  // Samples 0 2 4 6 1 3 5 7.
  const Floats8 fields = low(pairs[0], pairs[1]), fields_on = low(pairs[2], pairs[3]);
  const Floats8 powers = high(pairs[0], pairs[1]), powers_on = high(pairs[2], pairs[3]);
  const auto firsts = [](Floats8 a, Floats8 b) {
    return __builtin_shufflevector(a, b, 0, 4, 1, 5, 8, 12, 9, 13);
  };
  const auto seconds = [](Floats8 a, Floats8 b) {
    return __builtin_shufflevector(a, b, 2, 6, 3, 7, 10, 14, 11, 15);
  };
  store(firsts(fields, fields_on), to.real + k);
  store(seconds(fields, fields_on), to.imaginary + k);
  store(firsts(powers, powers_on) + seconds(powers, powers_on), to.power + k);
}

}  // namespace

template <bool even>
void LateralTaps::sumRows(const float* const* rows, const float* taps, int count,
                          std::ptrdiff_t from, std::ptrdiff_t to, const LineSums& sums) const {
  const std::ptrdiff_t stride =
      even ? static_cast<std::ptrdiff_t>(std::size(CacheLine{}.floats)) : kPiece * kNodeFloats;
  for (std::ptrdiff_t k = from; k < to; k += kSumStep) {
    Floats8 sum[kSumChains] = {};
    for (int m = 0; m < count; ++m) {
      const float* tap = taps + m * stride + (even ? 0 : (k - from) * kNodeFloats);
      const float* row = rows[m] + k * kNodeFloats;
      for (std::ptrdiff_t c = 0; c < kSumChains; ++c)
        sum[c] += lanesAt(tap + (even ? 0 : 8 * c)) * lanesAt(row + 8 * c);
    }
    storeSums(sum, k, sums);
  }
}

void LateralTaps::sum(const float* const* rows, int line, std::ptrdiff_t from, std::ptrdiff_t to,
                      const LineSums& sums) const {
  const Piece& phase = phases_[static_cast<std::size_t>(line % period_lines_) * pieces_ +
                               (even_ ? 0 : static_cast<std::size_t>(from / kPiece))];
  const float* const* first = rows + (phase.range.first - range_.first);
  if (even_)
    sumRows<true>(first, even_taps_[phase.first].floats, phase.range.count, from, to, sums);
  else
    sumRows<false>(first, reinterpret_cast<const float*>(taps_.data() + phase.first),
                   phase.range.count, from, to, sums);
}

}  // namespace echocine
