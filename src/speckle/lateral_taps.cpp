#include "speckle/lateral_taps.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

// Where taps change along the line, they are fitted at so many widths and interpolated.
constexpr int kFits = 48;
constexpr std::ptrdiff_t kSumChains = 4, kSumStep = 2 * kSumChains;  // samples

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
      range_(tapRange(*std::max_element(grid.deviations().begin(), grid.deviations().end()), 0,
                      grid.across().nodes(grid.across().coarser - 1))) {
  for (int line = 0; line < period_lines_; ++line) fit(grid, grid.across().nodes(line));
}

void LateralTaps::fit(const SplatGrid& grid, double phase) {
  const std::vector<double>& deviations = grid.deviations();
  const auto [least, most] = std::minmax_element(deviations.begin(), deviations.end());
  const TapRange range = tapRange(*most, phase, phase);
  const auto count = static_cast<std::size_t>(range.count);
  phases_.push_back({range, even_ ? even_taps_.size() : taps_.size()});
  if (even_) {
    const std::vector<double> taps = amplitudeTaps(*most, phase, range);
    for (std::size_t m = 0; m < count; ++m) {
      const Floats4 tap = tapOf(taps, m);
      CacheLine line{};
      std::memcpy(line.floats, &tap, sizeof tap);
      std::memcpy(line.floats + kNodeFloats, &tap, sizeof tap);
      even_taps_.push_back(line);
    }
    return;
  }
  std::vector<std::vector<double>> fits;
  for (int i = 0; i < kFits; ++i)
    fits.push_back(amplitudeTaps(*least + (*most - *least) * i / (kFits - 1), phase, range));
  const std::size_t first = taps_.size();
  taps_.resize(first + count * static_cast<std::size_t>(samples_));
  std::vector<double> taps(count);
  for (std::size_t k = 0; k < static_cast<std::size_t>(samples_); ++k) {
    const double deviation = deviations[std::min(k, deviations.size() - 1)];
    const double at = (deviation - *least) / (*most - *least) * (kFits - 1);
    const auto below = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kFits - 2));
    const double part = at - static_cast<double>(below);
    for (std::size_t m = 0; m < count; ++m)
      taps[m] = (1 - part) * fits[below][m] + part * fits[below + 1][m];
    for (std::size_t m = 0; m < count; ++m)
      taps_[first + m * static_cast<std::size_t>(samples_) + k] = tapOf(taps, m);
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
      even ? static_cast<std::ptrdiff_t>(std::size(CacheLine{}.floats)) : samples_ * kNodeFloats;
  for (std::ptrdiff_t k = from; k < to; k += kSumStep) {
    Floats8 sum[kSumChains] = {};
    for (int m = 0; m < count; ++m) {
      const float* tap = taps + m * stride + (even ? 0 : k * kNodeFloats);
      const float* row = rows[m] + k * kNodeFloats;
      for (std::ptrdiff_t c = 0; c < kSumChains; ++c)
        sum[c] += lanesAt(tap + (even ? 0 : 8 * c)) * lanesAt(row + 8 * c);
    }
    storeSums(sum, k, sums);
  }
}

void LateralTaps::sum(const float* const* rows, int line, std::ptrdiff_t from, std::ptrdiff_t to,
                      const LineSums& sums) const {
  const Phase& phase = phases_[static_cast<std::size_t>(line % period_lines_)];
  const float* const* first = rows + (phase.range.first - range_.first);
  if (even_)
    sumRows<true>(first, even_taps_[phase.first].floats, phase.range.count, from, to, sums);
  else
    sumRows<false>(first, reinterpret_cast<const float*>(taps_.data() + phase.first),
                   phase.range.count, from, to, sums);
}

}  // namespace echocine
