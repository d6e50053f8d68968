#include "output/half_plane.h"

#include <half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace echocine {

double halfScale(std::span<const float> values) {
  const auto largest = std::max_element(values.begin(), values.end());
  if (largest == values.end() || !(*largest > 0)) return 1;
  // One below the largest exponent of a half, 15: rounding up cannot overflow.
  constexpr int kTop = 14;
  return std::ldexp(1.0, kTop - std::ilogb(*largest));
}

void narrowToHalf(std::span<std::uint32_t> float_bits, double scale) {
  auto* out = reinterpret_cast<std::byte*>(float_bits.data());
  for (const std::uint32_t bits : float_bits) {
    // A power of two changes no digit, and scaled values fit a float.
    const double scaled = scale * static_cast<double>(std::bit_cast<float>(bits));
    const std::uint16_t half = Imath::half(static_cast<float>(scaled)).bits();
    std::memcpy(out, &half, sizeof half);  // never ahead of what is still to be read
    out += sizeof half;
  }
}

}  // namespace echocine
