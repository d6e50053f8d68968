#pragma once
// Logarithmic compression of intensities to grey.

#include <span>

namespace echocine {

// Base-2 logarithm of a positive normal float: the series errs by under 5e-8, and the result is a
// float, so within 1e-12..1 it is good to 2e-6, or 6e-6 dB of intensity.
// Zero and subnormal numbers give a value below -126.
float log2Fast(float x);

// grey = 1 + 10 log10(I / reference) / dynamic_range_db, limited to 0..1: the reference is white,
// everything dynamic_range_db and more below it, and an intensity of 0, is black. In place is
// allowed.
void compressIntensities(std::span<const float> intensities, double reference,
                         double dynamic_range_db, std::span<float> grey);

// The intensity that compresses to a grey value between 0 and 1, both left out.
double expandGrey(double grey, double reference, double dynamic_range_db);

}  // namespace echocine
