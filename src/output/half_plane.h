#pragma once
// Half floats hold 2^-14 to 65504 with eleven binary digits. Intensities relative to the
// transmitted one lie mostly below, so each plane is scaled by a power of two before it is
// narrowed.

#include <cstdint>
#include <span>

namespace echocine {

// The power of two that brings the largest value to between 2^14 and 2^15; 1 for a plane of zeros.
// Values down to 2^-28 of the largest (84 dB of intensity) then keep a relative error of 2^-11, and
// smaller ones err by under 2^-39 of the largest. Precondition: values are finite and not negative.
double halfScale(std::span<const float> values);

// The half floats of value * scale, rounded to the nearest, in the same memory: the bit patterns of
// floats come in, half as many bytes go out at the front.
void narrowToHalf(std::span<std::uint32_t> float_bits, double scale);

}  // namespace echocine
