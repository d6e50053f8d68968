#include "signal/reference.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

#include "core/check.h"
#include "scene/white_rule.h"

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

template <typename Counts>
void IntensityHistogram::count(std::span<const float> plane, const Counts& counts) {
  thread_local std::vector<std::uint32_t> local;
  local.assign(kBins, 0);
  for (std::size_t line = 0; line < plane.size(); line += static_cast<std::size_t>(samples_))
    for (int k = first_sample_; k < samples_; ++k) {
      const std::size_t at = line + static_cast<std::size_t>(k);
      if (!counts(at)) continue;
      // Infinities and NaN are rejected when they are written; here they must stay within the
      // bins.
      ++local[std::min<std::size_t>(std::bit_cast<std::uint32_t>(plane[at]) >> kShift, kBins - 1)];
    }
  for (std::size_t bin = 0; bin < kBins; ++bin)
    if (local[bin] != 0) counts_[bin].fetch_add(local[bin], std::memory_order_relaxed);
}

void IntensityHistogram::add(std::span<const float> plane) {
  count(plane, [](std::size_t) { return true; });
}

void IntensityHistogram::add(std::span<const float> plane, std::span<const std::uint32_t> medium,
                             std::span<const char> counted) {
  CHECK_EQ(plane.size(), medium.size());
  count(plane, [&](std::size_t at) { return medium[at] < counted.size() && counted[medium[at]]; });
}

std::uint64_t IntensityHistogram::positive() const {
  std::uint64_t total = 0;
  for (std::size_t bin = 1; bin < kBins; ++bin)  // bin 0 holds the samples without any intensity
    total += counts_[bin].load(std::memory_order_relaxed);
  return total;
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

WhiteMeasure::WhiteMeasure(const Scene& scene)
    : scene_(scene), all_(scene.probe), muscle_(scene.probe) {
  if (isWhiteByMuscle(scene)) muscle_media_ = muscleMedia(scene);
}

void WhiteMeasure::add(std::span<const float> intensities, std::span<const std::uint32_t> medium) {
  all_.add(intensities);
  if (!muscle_media_.empty()) muscle_.add(intensities, medium, muscle_media_);
}

double WhiteMeasure::white() const {
  const auto all = static_cast<double>(all_.positive());
  if (static_cast<double>(muscle_.positive()) > kLeastMuscle * all)
    return whiteOverMuscle(scene_.signal) * muscle_.percentile(50);
  const double asked = scene_.signal.reference_percentile;
  return all_.percentile(asked == kWhiteByMuscle ? kDefaultPercentile : asked);
}

}  // namespace echocine
