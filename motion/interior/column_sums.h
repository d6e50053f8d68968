#pragma once
// Sums over a lattice's nodes, by column.

#include <cstddef>
#include <cstring>

#include "core/lanes.h"

namespace echocine {

// One double per column.
template <std::size_t kLanes>
struct ColumnSums {
  Doubles4 parts[2 * kLanes]{};
  double operator[](std::size_t c) const { return parts[c / kDoubleLanes][c % kDoubleLanes]; }
  void add(std::size_t lane, Floats8 a, Floats8 b) {
    Floats4 halves[2][2];
    std::memcpy(halves[0], &a, sizeof a);
    std::memcpy(halves[1], &b, sizeof b);
    for (std::size_t h = 0; h < 2; ++h)
      parts[2 * lane + h] += __builtin_convertvector(halves[0][h], Doubles4) *
                             __builtin_convertvector(halves[1][h], Doubles4);
  }
  static ColumnSums scaled(ColumnSums sums, double factor) {
    for (Doubles4& part : sums.parts) part *= factor;
    return sums;
  }
  static ColumnSums larger(ColumnSums a, const ColumnSums& b) {
    for (std::size_t i = 0; i < 2 * kLanes; ++i)
      a.parts[i] = echocine::larger(a.parts[i], b.parts[i]);
    return a;
  }
  bool over(const ColumnSums& target) const {
    for (std::size_t c = 0; c < kLanes * kFloatLanes; ++c)
      if ((*this)[c] > target[c]) return true;
    return false;
  }
};

}  // namespace echocine
