#include "signal/edge_enhancement.h"

#include <algorithm>
#include <cmath>

#include "core/parallel.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

int halfOf(double width, int count) {
  return static_cast<int>(std::clamp(std::round((width - 1) / 2), 0.0, double(count)));
}

// Means along a line. Sums in double: rounding does not grow along the line.
void meansAlong(const float* from, int samples, int half, float* to) {
  double sum = 0;
  for (int k = 0; k < std::min(half, samples); ++k) sum += static_cast<double>(from[k]);
  for (int k = 0; k < samples; ++k) {
    if (k + half < samples) sum += static_cast<double>(from[k + half]);
    if (k - half > 0) sum -= static_cast<double>(from[k - half - 1]);
    const int count = std::min(k + half, samples - 1) - std::max(k - half, 0) + 1;
    to[k] = static_cast<float>(sum / count);
  }
}

}  // namespace

EdgeEnhancement::EdgeEnhancement(const Probe& probe, const SignalSettings& settings)
    : lines_(probe.lines),
      samples_(probe.samples),
      half_lines_(0),
      half_samples_(halfOf(settings.edge_size_m / probe.sampleSpacing(), probe.samples)),
      amount_(static_cast<float>(settings.edge_enhancement)) {
  const double spacing_m = lineSpacing(probe, probe.middleDepth());
  if (spacing_m > 0) half_lines_ = halfOf(settings.edge_size_m / spacing_m, probe.lines);
}

void EdgeEnhancement::apply(std::span<float> greys) const {
  const auto samples = static_cast<std::size_t>(samples_);
  std::vector<float> along(greys.size());
  parallelBlocks(static_cast<std::size_t>(lines_), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      meansAlong(&greys[i * samples], samples_, half_samples_, &along[i * samples]);
  });
  parallelBlocks(static_cast<std::size_t>(lines_), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<float> sums(samples);
    for (auto i = static_cast<int>(begin); i < static_cast<int>(end); ++i) {
      const int first = std::max(i - half_lines_, 0), last = std::min(i + half_lines_, lines_ - 1);
      std::fill(sums.begin(), sums.end(), 0.0f);
      for (int j = first; j <= last; ++j) {
        const float* const line = &along[static_cast<std::size_t>(j) * samples];
        for (std::size_t k = 0; k < samples; ++k) sums[k] += line[k];
      }
      const float share = 1 / static_cast<float>(last - first + 1);
      float* const line = &greys[static_cast<std::size_t>(i) * samples];
      for (std::size_t k = 0; k < samples; ++k)
        line[k] = std::clamp(line[k] + amount_ * (line[k] - share * sums[k]), 0.0f, 1.0f);
    }
  });
}

}  // namespace echocine
