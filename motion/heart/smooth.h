#pragma once
// Rounded maxima and steps.

#include <algorithm>
#include <cmath>

#include "core/lanes.h"

namespace echocine::heart {

// sqrt(x^2 + y^2) of lengths in metres, inline: std::hypot for numbers far from the limits of
// double. The last step corrects the rounding of the root (Borges, ACM Trans. Math. Softw. 47,
// Algorithm 1014, 2020), so the result is that of the C library, whose call takes longer.
inline double hypotenuse(double x, double y) {
  const double a = std::max(std::abs(x), std::abs(y)), b = std::min(std::abs(x), std::abs(y));
  if (b <= 0x1p-54 * a) return a + b;
  const double root = std::sqrt(a * a + b * b);
  const bool is_wide = root <= 2 * b;
  const double rest = root - (is_wide ? b : a);
  const double error = is_wide ? a * (2 * rest - a) + (rest - 2 * (a - b)) * rest
                               : 2 * rest * (a - 2 * b) + ((4 * rest - b) * b + rest * rest);
  return root - error / (2 * root);
}

// The same in lanes.
inline Doubles4 hypotenuse(Doubles4 x, Doubles4 y) {
  const Doubles4 of_x = magnitude(x), of_y = magnitude(y);
  const Doubles4 a = larger(of_x, of_y), b = smaller(of_x, of_y);
  const Doubles4 root = squareRoot(a * a + b * b);
  const Mask4 is_wide = root <= 2 * b;
  const Doubles4 rest = root - (is_wide ? b : a);
  const Doubles4 error = is_wide ? a * (2 * rest - a) + (rest - 2 * (a - b)) * rest
                                 : 2 * rest * (a - 2 * b) + ((4 * rest - b) * b + rest * rest);
  const Doubles4 corrected = root - error / (2 * root);
  return b <= 0x1p-54 * a ? a + b : corrected;
}

// The larger of two lengths, with a smooth transition over `rounding`. Never less than either, and
// at most rounding / 2 larger.
inline double smoothMax(double a, double b, double rounding) {
  return 0.5 * (a + b + hypotenuse(a - b, rounding));
}
inline Doubles4 smoothMax(Doubles4 a, Doubles4 b, double rounding) {
  return 0.5 * (a + b + hypotenuse(a - b, Doubles4{} + rounding));
}

// 0 below `from`, 1 above `to`, once differentiable.
inline double smoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}
inline Doubles4 smoothStep(double from, double to, Doubles4 x) {
  const Doubles4 t = clamped((x - from) / (to - from), Doubles4{}, Doubles4{} + 1);
  return t * t * (3 - 2 * t);
}

}  // namespace echocine::heart
