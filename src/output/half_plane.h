#pragma once
// Half floats represent 2^-14 to 65504 with eleven binary digits. Intensities relative to the
// transmitted one are mostly smaller, so each plane is scaled by a power of two before conversion.

#include <cstdint>
#include <span>

namespace echocine {

// The power of two that scales the largest value to between 2^14 and 2^15; 1 for a plane of zeros.
// Values down to 2^-28 of the largest (84 dB of intensity) then have a relative error of 2^-11;
// smaller ones have an error below 2^-39 of the largest. Precondition: values are finite and not
// negative.
double halfScale(std::span<const float> values);

// Half floats of value * scale, rounded to nearest, in the same memory: the input is bit patterns
// of floats; the output takes the first half of the bytes.
void narrowToHalf(std::span<std::uint32_t> float_bits, double scale);

}  // namespace echocine
