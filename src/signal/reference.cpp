#include "signal/reference.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace echocine {

namespace {

// The upper bits of a positive float's pattern grow with its value: sign, exponent and ten bits of
// mantissa make bins 1/1024 of an octave's start wide.
constexpr int kShift = 13;
constexpr std::size_t kBins = 0x7f800000u >> kShift;  // up to infinity

}  // namespace

IntensityHistogram::IntensityHistogram(const Probe& probe)
    : samples_(probe.samples), counts_(new std::atomic<std::uint64_t>[kBins]()) {
  constexpr double kNearField = 0.15;  // of the depth from the transducer
  const double first_m = kNearField * probe.max_depth_m - probe.min_depth_m;
  const double first = std::ceil(first_m / probe.sampleSpacing());
  first_sample_ = first > 0 && first < samples_ ? static_cast<int>(first) : 0;
}

void IntensityHistogram::add(std::span<const float> plane) {
  thread_local std::vector<std::uint32_t> local;
  local.assign(kBins, 0);
  for (std::size_t line = 0; line < plane.size(); line += static_cast<std::size_t>(samples_))
    for (int k = first_sample_; k < samples_; ++k)
      // What is infinite or not a number is refused when it is written; here it must not leave the
      // bins.
      ++local[std::min<std::size_t>(
          std::bit_cast<std::uint32_t>(plane[line + static_cast<std::size_t>(k)]) >> kShift,
          kBins - 1)];
  for (std::size_t bin = 0; bin < kBins; ++bin)
    if (local[bin] != 0) counts_[bin].fetch_add(local[bin], std::memory_order_relaxed);
}

double IntensityHistogram::percentile(double percent) const {
  std::uint64_t total = 0;
  std::size_t last = 0;
  for (std::size_t bin = 1; bin < kBins; ++bin)  // bin 0 holds the samples without any intensity
    if (const std::uint64_t n = counts_[bin].load(std::memory_order_relaxed)) {
      total += n;
      last = bin;
    }
  const auto edge = [](std::size_t bin) {
    return static_cast<double>(
        std::bit_cast<float>(static_cast<std::uint32_t>((bin + 1) << kShift)));
  };
  if (last == 0) return 1;
  const double wanted = percent / 100 * static_cast<double>(total);
  std::uint64_t below = 0;
  for (std::size_t bin = 1; bin < last; ++bin) {
    const std::uint64_t here = counts_[bin].load(std::memory_order_relaxed);
    below += here;
    if (here > 0 && static_cast<double>(below) >= wanted) return edge(bin);
  }
  return edge(last);
}

}  // namespace echocine
