#include "signal/lung_echo.h"

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/parallel.h"
#include "core/units.h"
#include "plan/media_in_use.h"

namespace echocine {

LungEcho::LungEcho(const Scene& scene) : samples_(static_cast<std::size_t>(scene.probe.samples)) {
  for (const Medium& medium : scene.media) air_.push_back(isAirFilled(medium));
  const double level = intensityFromDecibels(scene.artefacts.lung_db),
               step = scene.probe.sampleSpacing() / scene.artefacts.lung_length_m;
  for (std::size_t m = 0; m < samples_; ++m)
    levels_.push_back(static_cast<float>(level * std::exp(-static_cast<double>(m) * step)));
}

void LungEcho::add(std::span<const std::uint32_t> media, std::span<float> plane) const {
  CHECK_EQ(media.size(), plane.size());
  constexpr std::size_t kAtOnce = 8;  // lines. Our choice
  parallelBlocks(plane.size() / samples_, kAtOnce, [&](std::size_t begin, std::size_t end) {
    thread_local std::vector<double> sums;
    for (std::size_t i = begin; i < end; ++i)
      addLine(media.subspan(i * samples_, samples_), plane.subspan(i * samples_, samples_), sums);
  });
}

void LungEcho::addLine(std::span<const std::uint32_t> media, std::span<float> line,
                       std::vector<double>& sums) const {
  const auto surface = static_cast<std::size_t>(
      std::find_if(media.begin(), media.end(),
                   [&](std::uint32_t id) { return id < air_.size() && air_[id] != 0; }) -
      media.begin());
  if (surface == 0 || surface == samples_) return;
  sums.assign(1, 0);  // of the samples in front of the surface, from the surface on
  for (std::size_t s = 0; s < surface; ++s)
    sums.push_back(sums.back() + static_cast<double>(line[surface - 1 - s]));
  for (std::size_t m = 0; surface + m < samples_; ++m) {
    const std::size_t turned = m % (2 * surface), d = std::min(turned, 2 * surface - 1 - turned),
                      w = m / 5;
    const std::size_t first = d > w ? d - w : 0, last = std::min(d + w + 1, surface);
    line[surface + m] +=
        static_cast<float>(static_cast<double>(levels_[m]) * (sums[last] - sums[first]) /
                           static_cast<double>(last - first));
  }
}

}  // namespace echocine
