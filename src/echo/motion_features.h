#pragma once
// A loop's frames as short vectors of their moving parts, for finding the beat.

#include <vector>

#include "echo/resample.h"

namespace echocine::echo {

// For each frame: weighted means over blocks of beam space (about 32 x 48 of them), minus their
// mean over the loop, times the square root of the block's weight. Inner products then measure the
// moving parts of the picture.
using Features = std::vector<std::vector<double>>;
Features motionFeatures(const BeamGrid& grid, const BeamLoop& loop,
                        const std::vector<float>& weights);

}  // namespace echocine::echo
