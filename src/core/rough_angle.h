#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/lanes.h"

namespace echocine {

// The arctangent of 0..1 to 1e-5 rad (Abramowitz and Stegun, 4.4.49), for scalars or lanes.
template <typename T>
T roughArctangent(T q) {
  const T q2 = q * q;
  return q *
         (0.9998660 + q2 * (-0.3302995 + q2 * (0.1801410 + q2 * (-0.0851330 + q2 * 0.0208351))));
}

// atan2(x, z) to 1e-5 rad: a first guess that an exact comparison then corrects. x = z = 0 gives 0.
inline double roughAngle(double x, double z) {
  const double ax = std::abs(x), az = std::abs(z);
  const double large = std::max(ax, az), small = std::min(ax, az);
  const double q = large > 0 ? small / large : 0;
  const double angle = roughArctangent(q), ahead = ax > az ? std::numbers::pi / 2 - angle : angle;
  return std::copysign(z < 0 ? std::numbers::pi - ahead : ahead, x);
}

// The same in lanes.
inline Doubles4 roughAngle(Doubles4 x, Doubles4 z) {
  const Doubles4 ax = magnitude(x), az = magnitude(z), none{};
  const Doubles4 large = larger(ax, az), small = smaller(ax, az);
  const Doubles4 angle = roughArctangent(large > 0 ? small / large : none),
                 ahead = ax > az ? std::numbers::pi / 2 - angle : angle,
                 turned = z < 0 ? std::numbers::pi - ahead : ahead;
  return x < 0 ? -turned : turned;
}

}  // namespace echocine
