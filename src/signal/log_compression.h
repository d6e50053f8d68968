#pragma once
// Logarithmic compression of intensities to grey.

#include <span>

namespace echocine {

// grey = 1 + 10 log10(I / reference) / dynamic_range_db, limited to 0..1: the reference is white,
// everything dynamic_range_db and more below it, and an intensity of 0 or subnormal, is black. The
// logarithm errs by under 2e-7 dB, the sum that is a float by its rounding. In place is allowed.
void compressIntensities(std::span<const float> intensities, double reference,
                         double dynamic_range_db, std::span<float> grey);

// The intensity that compresses to a grey value between 0 and 1, both left out.
double expandGrey(double grey, double reference, double dynamic_range_db);

}  // namespace echocine
