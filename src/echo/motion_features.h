#pragma once
// A loop's frames as short vectors of what moves, for finding the beat in them.

#include <vector>

#include "echo/resample.h"

namespace echocine::echo {

// Each frame: weighted means over blocks of beam space (about 32 x 48 of them), less their mean
// over the loop, times the square root of the block's weight. Inner products are then those of what
// moves in the picture.
using Features = std::vector<std::vector<double>>;
Features motionFeatures(const BeamGrid& grid, const BeamLoop& loop,
                        const std::vector<float>& weights);

}  // namespace echocine::echo
