#include "speckle/lateral_taps.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

// Where taps change along the line, they are fitted at so many widths and interpolated.
constexpr int kFits = 48;
constexpr std::ptrdiff_t kSumChains = 4, kSumStep = 2 * kSumChains;  // nodes

Floats4 tapOf(const std::vector<double>& taps, std::size_t m) {
  const double h = taps[m], next = m + 1 < taps.size() ? taps[m + 1] : 0;
  const auto amplitude = static_cast<float>(h);
  return Floats4{amplitude, amplitude, static_cast<float>(h * h), static_cast<float>(h * next)};
}

}  // namespace

LateralTaps::LateralTaps(const SplatGrid& grid)
    : lines_per_row_(grid.across().coarser),
      rows_per_line_(grid.across().finer),
      even_(grid.even()),
      nodes_(grid.nodes() + 2 * kBeside),
      range_(tapRange(*std::max_element(grid.deviations().begin(), grid.deviations().end()), 0,
                      1 - 1.0 / lines_per_row_)) {
  for (int line = 0; line < lines_per_row_; ++line)
    fit(grid, static_cast<double>(line) / lines_per_row_);
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
  taps_.resize(first + count * static_cast<std::size_t>(nodes_));
  std::vector<double> taps(count);
  for (std::size_t n = 0; n < static_cast<std::size_t>(nodes_); ++n) {
    const std::ptrdiff_t node =
        std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(n) - kBeside, 0, grid.nodes() - 1);
    const double at =
        (deviations[static_cast<std::size_t>(node)] - *least) / (*most - *least) * (kFits - 1);
    const auto below = std::min(static_cast<std::size_t>(at), static_cast<std::size_t>(kFits - 2));
    const double part = at - static_cast<double>(below);
    for (std::size_t m = 0; m < count; ++m)
      taps[m] = (1 - part) * fits[below][m] + part * fits[below + 1][m];
    for (std::size_t m = 0; m < count; ++m)
      taps_[first + m * static_cast<std::size_t>(nodes_) + n] = tapOf(taps, m);
  }
}

template <bool even>
void LateralTaps::sumNodes(const float* const* rows, const float* taps, int count,
                           std::ptrdiff_t from, std::ptrdiff_t to, float* sums) const {
  const std::ptrdiff_t stride =
      even ? static_cast<std::ptrdiff_t>(std::size(CacheLine{}.floats)) : nodes_ * kNodeFloats;
  for (std::ptrdiff_t n = from; n < to; n += kSumStep) {
    Floats8 sum[kSumChains] = {};
    for (int m = 0; m < count; ++m) {
      const float* tap = taps + m * stride + (even ? 0 : (n + kBeside) * kNodeFloats);
      const float* row = rows[m] + n * kNodeFloats;
      for (std::ptrdiff_t c = 0; c < kSumChains; ++c)
        sum[c] += lanesAt(tap + (even ? 0 : 8 * c)) * lanesAt(row + 8 * c);
    }
    for (std::ptrdiff_t c = 0; c < kSumChains; ++c) store(sum[c], sums + n * kNodeFloats + 8 * c);
  }
}

void LateralTaps::sum(const float* const* rows, int line, std::ptrdiff_t from, std::ptrdiff_t to,
                      float* sums) const {
  const Phase& phase = phases_[static_cast<std::size_t>(line % lines_per_row_)];
  const float* const* first = rows + (phase.range.first - range_.first);
  if (even_)
    sumNodes<true>(first, even_taps_[phase.first].floats, phase.range.count, from, to, sums);
  else
    sumNodes<false>(first, reinterpret_cast<const float*>(taps_.data() + phase.first),
                    phase.range.count, from, to, sums);
}

}  // namespace echocine
