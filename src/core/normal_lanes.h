#pragma once
// Complex Gaussian numbers in SIMD lanes: a function of a key and a counter.

#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/lanes.h"

namespace echocine {

struct ComplexLanes {
  Floats8 real, imaginary;
};

// sin(pi x / 2) for |x| <= 1, to 1e-6 (Hastings, "Approximations for Digital Computers", 1955).
inline Floats8 sineOfQuarters(Floats8 x) {
  const Floats8 x2 = x * x;
  return x * (1.570794852f + x2 * (-0.645920978f + x2 * (0.079487663f + x2 * -0.004362476f)));
}

// exp(2 pi j f) for |f| <= 1/2, to 1e-6.
inline ComplexLanes phasor(Floats8 f) {
  const Floats8 part = f < 0 ? -f : f;
  const Floats8 half = f < 0 ? Floats8{} - 0.5f : Floats8{} + 0.5f;
  return {sineOfQuarters(1 - 4 * part), sineOfQuarters(4 * (part > 0.25f ? half - f : f))};
}

// ln x of normal numbers, to 2e-7: x = 2^e m with m in [sqrt(1/2), sqrt 2), ln m = 2 artanh s with
// s = (m - 1) / (m + 1).
inline Floats8 naturalLogarithm(Floats8 x) {
  constexpr std::uint32_t kRootHalf = 0x3f3504f3;  // bits of sqrt(1/2)
  const auto bits = std::bit_cast<Uints8>(x);
  const Ints8 e = std::bit_cast<Ints8>(bits - kRootHalf) >> 23;
  const auto m = std::bit_cast<Floats8>(bits - (std::bit_cast<Uints8>(e) << 23));
  const Floats8 s = (m - 1) / (m + 1), s2 = s * s;
  return __builtin_convertvector(e, Floats8) * static_cast<float>(std::numbers::ln2) +
         s * (2 + s2 * (2.0f / 3 + s2 * (2.0f / 5 + s2 * (2.0f / 7))));
}

// A bijection of 32 bits in which every input bit affects every output bit (C. Wellons,
// "Prospecting for Hash Functions", 2018).
inline Uints8 mixedLanes(Uints8 x) {
  x ^= x >> 16;
  x *= 0x21f0aaadu;
  x ^= x >> 15;
  x *= 0xd35a2d97u;
  return x ^ x >> 15;
}

// E|z|^2 = 1. Lane i is the number `first + i` of the key. Box and Muller's method with 24 bits of
// radius and of angle; |z|^2 is at most 17.3.
inline ComplexLanes complexNormals(std::uint64_t key, std::uint32_t first) {
  constexpr Uints8 kLane{0, 1, 2, 3, 4, 5, 6, 7};
  constexpr float kUnit = 0x1p-24f;
  const auto low = static_cast<std::uint32_t>(key), high = static_cast<std::uint32_t>(key >> 32);
  const Uints8 counter = (kLane + first) * 0x9e3779b9u;
  const Uints8 one = mixedLanes(mixedLanes(counter + low) ^ high),
               two = mixedLanes(one ^ mixedLanes(counter ^ high));
  const Floats8 u =
      (__builtin_convertvector(std::bit_cast<Ints8>(one >> 8), Floats8) + 0.5f) * kUnit;
  const Floats8 f = __builtin_convertvector(std::bit_cast<Ints8>(two >> 8), Floats8) * kUnit - 0.5f;
  const Floats8 power = -naturalLogarithm(u);
  Floats8 radius;
  for (std::size_t i = 0; i < kFloatLanes; ++i) radius[i] = std::sqrt(power[i] > 0 ? power[i] : 0);
  const ComplexLanes turned = phasor(f);
  return {radius * turned.real, radius * turned.imaginary};
}

}  // namespace echocine
