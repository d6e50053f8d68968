#pragma once
// The laws of interface_law.h for four interfaces at once.

#include "trace/lanes.h"

namespace echocine {

// InterfaceLaw::R of interfaceLaw(), to rounding. cos_i: 0..1.
inline Lanes reflectedShares(Lanes Z_1, Lanes c_1, Lanes Z_2, Lanes c_2, Lanes cos_i) {
  const Lanes per_c_1 = 1 / c_1, r = c_2 * per_c_1;
  const Lanes turn = (c_1 - c_2) * per_c_1 * (1 + r);  // 1 - r^2
  const Lanes cos_t_squared = turn + r * r * cos_i * cos_i;
  const Lanes cos_t = smaller(squareRoot(larger(cos_t_squared, 0)), 1);
  const Lanes a = Z_2 * cos_i, b = Z_1 * cos_t, sum = a + b;
  // a - b of nearly equal media, as amplitudeDifference() takes it
  const Lanes cosines = cos_i + cos_t;
  const Lanes by_Z = (Z_2 - Z_1) * cos_i,
              by_c = -Z_1 * turn * (1 - cos_i) * (1 + cos_i) / cosines;  // not a number at 0 / 0
  const Lanes difference = magnitude(by_Z) + magnitude(by_c) < sum ? by_Z + by_c : a - b;
  const Lanes ratio = (sum > 0 ? difference : Z_2 - Z_1) / (sum > 0 ? sum : Z_2 + Z_1);
  const LaneMask total = (cos_t_squared <= 0) & (c_2 > c_1);
  return total ? Lanes{} + 1 : ratio * ratio;
}

}  // namespace echocine
