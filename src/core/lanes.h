#pragma once
// SIMD lanes in the vector extension of GCC and Clang, for loops that compilers do not vectorise
// well. Every lane gives the result of scalar code, so results depend neither on the grouping of
// numbers nor on the instruction set.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace echocine {

inline constexpr std::size_t kFloatLanes = 8, kDoubleLanes = 4;

using Floats8 = float __attribute__((vector_size(32)));
using Ints8 = std::int32_t __attribute__((vector_size(32)));
using Uints8 = std::uint32_t __attribute__((vector_size(32)));
using Shorts8 = std::uint16_t __attribute__((vector_size(16)));
using Doubles4 = double __attribute__((vector_size(32)));
using Mask4 = std::int64_t __attribute__((vector_size(32)));  // -1 where true, else 0
using Ints4 = std::int32_t __attribute__((vector_size(16)));
using Floats4 = float __attribute__((vector_size(16)));

inline Floats8 lanesAt(const float* from) {
  Floats8 lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline Floats4 fourAt(const float* from) {
  Floats4 lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline Doubles4 lanesAt(const double* from) {
  Doubles4 lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline Ints8 intsAt(const std::uint32_t* from) {
  Ints8 lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline Mask4 masksAt(const std::int64_t* from) {
  Mask4 mask;
  std::memcpy(&mask, from, sizeof mask);
  return mask;
}

inline void store(Floats8 lanes, float* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}
inline void store(Doubles4 lanes, double* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}
inline void store(Mask4 mask, std::int64_t* to) {
  std::memcpy(to, &mask, sizeof mask);
}
template <typename Number>
void store(Ints4 lanes, Number* to) {
  static_assert(sizeof(Number) == sizeof(std::int32_t));
  std::memcpy(to, &lanes, sizeof lanes);
}
// The first `count` lanes, the others 0; all of them by a plain load.
inline Floats8 someLanesAt(const float* from, std::size_t count) {
  if (count >= kFloatLanes) return lanesAt(from);
  Floats8 lanes{};
  std::memcpy(&lanes, from, count * sizeof(float));
  return lanes;
}
// The first `count` lanes; all of them by a plain store.
inline void storeSome(Floats8 lanes, std::size_t count, float* to) {
  if (count >= kFloatLanes)
    store(lanes, to);
  else
    std::memcpy(to, &lanes, count * sizeof(float));
}

inline constexpr double kTiny = 1e-300;  // instead of 0 in a denominator

inline Floats8 larger(Floats8 a, Floats8 b) {
  return a > b ? a : b;
}
inline Floats8 smaller(Floats8 a, Floats8 b) {
  return a < b ? a : b;
}
inline Doubles4 larger(Doubles4 a, Doubles4 b) {
  return a > b ? a : b;
}
inline Doubles4 smaller(Doubles4 a, Doubles4 b) {
  return a < b ? a : b;
}
inline Doubles4 larger(Doubles4 a, double b) {
  return larger(a, Doubles4{} + b);
}
inline Doubles4 smaller(Doubles4 a, double b) {
  return smaller(a, Doubles4{} + b);
}
inline Doubles4 clamped(Doubles4 a, Doubles4 low, Doubles4 high) {
  return smaller(larger(a, low), high);
}
inline Doubles4 magnitude(Doubles4 a) {
  constexpr std::int64_t kAllButTheSign = std::numeric_limits<std::int64_t>::max();
  return reinterpret_cast<Doubles4>(reinterpret_cast<Mask4>(a) & kAllButTheSign);
}
inline Doubles4 squareRoot(Doubles4 a) {
  return Doubles4{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}
// Truncated towards zero; for magnitudes below 2^31.
inline Doubles4 wholeOf(Doubles4 a) {
  return __builtin_convertvector(__builtin_convertvector(a, Ints4), Doubles4);
}

// The first four lanes, or the last four, in double precision; and back.
inline Doubles4 lowHalf(Floats8 a) {
  return __builtin_convertvector(__builtin_shufflevector(a, a, 0, 1, 2, 3), Doubles4);
}
inline Doubles4 highHalf(Floats8 a) {
  return __builtin_convertvector(__builtin_shufflevector(a, a, 4, 5, 6, 7), Doubles4);
}
inline Floats8 joined(Floats4 low, Floats4 high) {
  return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7);
}
inline Floats8 joined(Doubles4 low, Doubles4 high) {
  return joined(__builtin_convertvector(low, Floats4), __builtin_convertvector(high, Floats4));
}

// e^x with a relative error of 2e-7: e^x = 2^n e^r with |r| <= ln 2 / 2, e^r by the polynomial of
// Cephes' expf (Moshier 1989). Clamped beyond +-87.
inline Floats8 exponential(Floats8 x) {
  constexpr float kMost = 87;
  x = x > kMost ? Floats8{} + kMost : x;
  x = x < -kMost ? Floats8{} - kMost : x;
  const Floats8 scaled = x * 1.44269504F;
  const Ints8 n =
      __builtin_convertvector(scaled + (scaled > 0 ? Floats8{} + 0.5F : Floats8{} - 0.5F), Ints8);
  const Floats8 whole = __builtin_convertvector(n, Floats8);
  // ln 2 in two parts; n times the first part is exact.
  const Floats8 r = x - whole * 0.693359375F + whole * 2.12194440e-4F;
  Floats8 p = r * 1.9875691500e-4F + 1.3981999507e-3F;
  p = p * r + 8.3334519073e-3F;
  p = p * r + 4.1665795894e-2F;
  p = p * r + 1.6666665459e-1F;
  p = p * r + 5.0000001201e-1F;
  p = p * r * r + r + 1;
  return p * reinterpret_cast<Floats8>((n + 127) << 23);
}

// Bit i: lane i of a mask, whose lanes are -1 where true, else 0.
inline unsigned bitsOf(Ints8 mask) {
#ifdef __AVX2__
  return static_cast<unsigned>(__builtin_ia32_movmskps256(reinterpret_cast<Floats8>(mask)));
#else
  unsigned bits = 0;
  for (unsigned i = 0; i < kFloatLanes; ++i) bits |= (static_cast<unsigned>(mask[i]) & 1) << i;
  return bits;
#endif
}

// Lane i of the result is lane order[i]. Orders are 0 to 7.
inline Floats8 reordered(Floats8 a, Ints8 order) {
#ifdef __AVX2__
  return __builtin_ia32_permvarsf256(a, order);
#else
  Floats8 out;
  for (std::size_t i = 0; i < kFloatLanes; ++i) out[i] = a[order[i]];
  return out;
#endif
}

inline bool any(Mask4 mask) {
  return ((mask[0] | mask[1]) | (mask[2] | mask[3])) != 0;
}

}  // namespace echocine
