#pragma once
// The laws of interface_law.h for four interfaces at once.

#include "core/lanes.h"

namespace echocine {

// The speeds of two media, for Snell's law.
struct SpeedRatio {
  double r = 1;     // c_2 / c_1; exactly 1 for equal speeds
  double turn = 0;  // 1 - r^2 as in transmissionCosine(): exact for equal speeds
};

inline SpeedRatio speedRatio(double c_1, double c_2) {
  const double r = c_2 / c_1;
  return {r, (c_1 - c_2) / c_1 * (1 + r)};
}

// InterfaceLaw::R of media with equal speeds, at every angle.
inline Doubles4 reflectedAtEqualSpeeds(Doubles4 Z_1, Doubles4 Z_2) {
  const Doubles4 ratio = (Z_2 - Z_1) / (Z_2 + Z_1);
  return ratio * ratio;
}

// InterfaceLaw::R of any media, to rounding. r, turn: their SpeedRatio; cos_i: 0..1. Both the plain
// difference a - b and that of nearly equal media (amplitudeDifference(), by Z and by c) are
// multiplied by cos_i + cos_t here, so that one division suffices.
inline Doubles4 reflectedShares(Doubles4 Z_1, Doubles4 Z_2, Doubles4 r, Doubles4 turn,
                                Doubles4 cos_i) {
  const Doubles4 cos_t_squared = turn + r * r * cos_i * cos_i;
  const Doubles4 cos_t = smaller(squareRoot(larger(cos_t_squared, 0)), 1);
  const Doubles4 a = Z_2 * cos_i, b = Z_1 * cos_t, cosines = cos_i + cos_t;
  const Doubles4 sum = (a + b) * cosines;
  const Doubles4 by_Z = (Z_2 - Z_1) * cos_i * cosines,
                 by_c = -Z_1 * turn * (1 - cos_i) * (1 + cos_i);
  const Doubles4 difference =
      magnitude(by_Z) + magnitude(by_c) < sum ? by_Z + by_c : (a - b) * cosines;
  const Mask4 any_angle = sum > 0;  // otherwise both cosines are 0
  const Doubles4 ratio = (any_angle ? difference : Z_2 - Z_1) / (any_angle ? sum : Z_2 + Z_1);
  const Mask4 total = (cos_t_squared <= 0) & (r > 1);
  return total ? Doubles4{} + 1 : ratio * ratio;
}

}  // namespace echocine
