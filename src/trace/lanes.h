#pragma once
// Four doubles at once, in the vector extension that GCC and Clang share. Every lane is computed as
// one number would be, so it does not matter which numbers stand together.

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace echocine {

inline constexpr std::size_t kLanes = 4;
using Lanes = double __attribute__((vector_size(kLanes * sizeof(double))));
using LaneMask = std::int64_t __attribute__((vector_size(kLanes * sizeof(std::int64_t))));

using LaneInts = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

inline Lanes lanesAt(const double* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
inline void store(Lanes lanes, double* to) {
  std::memcpy(to, &lanes, sizeof lanes);
}

inline LaneMask masksAt(const std::int64_t* from) {
  LaneMask mask;
  std::memcpy(&mask, from, sizeof mask);
  return mask;
}
template <typename Number>
void store(LaneInts lanes, Number* to) {
  static_assert(sizeof(Number) == sizeof(std::int32_t));
  std::memcpy(to, &lanes, sizeof lanes);
}
inline void store(LaneMask mask, std::int64_t* to) {
  std::memcpy(to, &mask, sizeof mask);
}

inline Lanes larger(Lanes a, Lanes b) {
  return a > b ? a : b;
}
inline Lanes smaller(Lanes a, Lanes b) {
  return a < b ? a : b;
}
inline Lanes larger(Lanes a, double b) {
  return larger(a, Lanes{} + b);
}
inline Lanes smaller(Lanes a, double b) {
  return smaller(a, Lanes{} + b);
}
inline Lanes clamped(Lanes a, Lanes low, Lanes high) {
  return smaller(larger(a, low), high);
}
inline Lanes magnitude(Lanes a) {
  constexpr std::int64_t kAllButTheSign = std::numeric_limits<std::int64_t>::max();
  return reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(a) & kAllButTheSign);
}
inline Lanes squareRoot(Lanes a) {
  return Lanes{std::sqrt(a[0]), std::sqrt(a[1]), std::sqrt(a[2]), std::sqrt(a[3])};
}

// Without their fractions; magnitudes below 2^31.
inline Lanes wholeOf(Lanes a) {
  return __builtin_convertvector(__builtin_convertvector(a, LaneInts), Lanes);
}

inline bool any(LaneMask mask) {
  return ((mask[0] | mask[1]) | (mask[2] | mask[3])) != 0;
}

}  // namespace echocine
