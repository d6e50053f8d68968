#pragma once
// Rounded maxima and steps.

#include <algorithm>
#include <cmath>

namespace echocine::heart {

// The larger of two lengths, with a smooth transition over `rounding`. Never less than either, and
// at most rounding / 2 larger.
inline double smoothMax(double a, double b, double rounding) {
  return 0.5 * (a + b + std::hypot(a - b, rounding));
}

// 0 below `from`, 1 above `to`, once differentiable.
inline double smoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace echocine::heart
