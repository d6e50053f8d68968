#pragma once
// Eight numbers at once in the vector extension that GCC and Clang share, for loops that compilers
// left to themselves shuffle or unroll. Each lane is rounded as a single number would be, so that
// results do not depend on the instruction set.

#include <cstdint>
#include <cstring>

namespace echocine {

inline constexpr int kLanes = 8;
using Lanes = float __attribute__((vector_size(kLanes * sizeof(float))));
using IntLanes = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

inline Lanes lanesAt(const float* from) {
  Lanes lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

// The first `count` lanes; all of them by a plain store.
inline void storeLanes(Lanes lanes, std::size_t count, float* to) {
  if (count >= kLanes)
    std::memcpy(to, &lanes, sizeof lanes);
  else
    std::memcpy(to, &lanes, count * sizeof(float));
}

}  // namespace echocine
