#pragma once
// Loops in beam space, for any placement.

#include <vector>

#include "echo/beam_grid.h"

namespace echocine::echo {

// A loop in beam space, line-major. Pictures finer than the grid are first smoothed to its spacing.
// Grey 0 to 255.
struct BeamLoop {
  std::vector<std::vector<float>> frames;
  PixelPlane valid;  // 1: within the sector, not under an overlay
};

// Pixel by pixel, for frames of one size; at least one.
template <typename Frame>
std::vector<float> meanOf(const std::vector<Frame>& frames) {
  std::vector<float> mean(frames.front().size(), 0);
  for (const Frame& frame : frames)
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += static_cast<float>(frame[i]);
  for (float& m : mean) m /= static_cast<float>(frames.size());
  return mean;
}

// Runs in parallel.
BeamLoop resample(const BeamGrid& grid, const EchoLoop& loop, const Placement& placement = {});

// The same in two steps, for repeated placements of a loop.
class LoopSampler {
 public:
  // References are kept.
  LoopSampler(const BeamGrid& grid, const EchoLoop& loop);

  int width() const;  // of picture()
  // A frame for sampling, smoothed to the grid's spacing: the loop's picture, or its grey levels in
  // beam space if it has them.
  std::vector<float> picture(std::size_t frame) const;
  std::vector<float> meanPicture() const;
  // Positions of the grid's samples in it and in the loop's picture; line-major.
  std::vector<PixelPlace> places(const Placement& placement) const;
  std::vector<PixelPlace> placesInLoop(const Placement& placement) const;

 private:
  template <typename AtPlace>
  std::vector<PixelPlace> everyPlace(const Placement& placement, const AtPlace& at) const;
  std::vector<float> smoothed(std::vector<float> picture) const;

  const BeamGrid& grid_;
  const EchoLoop& loop_;
  bool traced_;
  double sigma_x_ = 0, sigma_y_ = 0;
};

}  // namespace echocine::echo
