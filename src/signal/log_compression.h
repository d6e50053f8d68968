#pragma once
// Logarithmic compression of intensities to grey levels.

#include <span>

namespace echocine {

// grey = 1 + 10 log10(I / reference) / dynamic_range_db, limited to 0..1. The reference is white.
// Intensities at least dynamic_range_db below it, 0 and subnormal ones are black. The logarithm has
// an error below 2e-7 dB, the result that of float rounding. May be in place.
void compressIntensities(std::span<const float> intensities, double reference,
                         double dynamic_range_db, std::span<float> grey);

}  // namespace echocine
