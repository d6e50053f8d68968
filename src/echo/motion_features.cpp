#include "echo/motion_features.h"

#include <algorithm>
#include <cmath>

namespace echocine::echo {

Features motionFeatures(const BeamGrid& grid, const BeamLoop& loop,
                        const std::vector<float>& weights) {
  constexpr int kAcross = 32, kAlong = 48;  // our choice: a wall's motion of a few mm is seen
  const int across = std::min(kAcross, grid.lines), along = std::min(kAlong, grid.samples);
  const auto blocks = static_cast<std::size_t>(across * along);
  std::vector<std::size_t> block_of(grid.size());
  std::vector<double> weight(blocks, 0);
  for (int i = 0; i < grid.lines; ++i)
    for (int k = 0; k < grid.samples; ++k) {
      const std::size_t at = static_cast<std::size_t>(i) * static_cast<std::size_t>(grid.samples) +
                             static_cast<std::size_t>(k);
      block_of[at] =
          static_cast<std::size_t>(i * across / grid.lines * along + k * along / grid.samples);
      weight[block_of[at]] += weights[at];
    }
  Features features;
  std::vector<double> mean(blocks, 0);
  for (const std::vector<float>& frame : loop.frames) {
    std::vector<double> f(blocks, 0);
    for (std::size_t at = 0; at < frame.size(); ++at)
      f[block_of[at]] += static_cast<double>(weights[at]) * frame[at];
    for (std::size_t b = 0; b < blocks; ++b) {
      // A block's mean times the root of its area: squared distances then are area integrals.
      f[b] = weight[b] > 0 ? f[b] / std::sqrt(weight[b]) : 0;
      mean[b] += f[b] / static_cast<double>(loop.frames.size());
    }
    features.push_back(std::move(f));
  }
  // Static parts have no information about time, and would hide the motion.
  for (std::vector<double>& f : features)
    for (std::size_t b = 0; b < blocks; ++b) f[b] -= mean[b];
  return features;
}

}  // namespace echocine::echo
