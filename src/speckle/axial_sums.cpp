#include "speckle/axial_sums.h"

#include <algorithm>

namespace echocine {

AxialSums::AxialSums(const SplatGrid& grid, double deviation_samples)
    : finer_(grid.along().finer), coarser_(grid.along().coarser) {
  const double deviation = grid.along().nodes(deviation_samples);
  range_ = tapRange(deviation, 0, 1 - 1.0 / coarser_);
  std::vector<std::vector<double>> amplitudes, powers;
  for (int phase = 0; phase < coarser_; ++phase) {
    amplitudes.push_back(amplitudeTaps(deviation, static_cast<double>(phase) / coarser_, range_));
    powers.push_back(powerTaps(amplitudes.back(), range_));
  }
  for (std::size_t first = 0; first < amplitudes.size(); first += 2) {
    const std::size_t second = std::min(first + 1, amplitudes.size() - 1);
    for (std::size_t t = 0; t < static_cast<std::size_t>(range_.count); ++t) {
      const auto k1 = static_cast<float>(amplitudes[first][t]),
                 h1 = static_cast<float>(powers[first][t]),
                 k2 = static_cast<float>(amplitudes[second][t]),
                 h2 = static_cast<float>(powers[second][t]);
      taps_.push_back(Floats8{k1, k1, h1, h1, k2, k2, h2, h2});
    }
  }
}

}  // namespace echocine
