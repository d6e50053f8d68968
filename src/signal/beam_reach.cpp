// Samples that the average over the beam needs for a subset of the lines.

#include <algorithm>

#include "signal/beam_width.h"

namespace echocine {

std::vector<int> BeamAverage::taken(LineRange lines) const {
  std::vector<int> samples(static_cast<std::size_t>(lines_), 0);
  std::fill(samples.begin() + lines.first, samples.begin() + lines.end, samples_);
  const int reach = static_cast<int>(taps_.size()) / 2;
  for (const Run& run : runs_)
    for (int i = std::max(lines.first + run.below, 0); i < std::min(lines.end + run.above, lines_);
         ++i)
      samples[static_cast<std::size_t>(i)] =
          std::max(samples[static_cast<std::size_t>(i)], std::min(run.last + reach, samples_));
  return samples;
}

}  // namespace echocine
