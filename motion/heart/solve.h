#pragma once
// Root finding for shapes of a required volume.

#include <cmath>
#include <utility>

namespace echocine::heart {

// The x in [low, high] at which a continuous increasing function equals `wanted`, within
// `tolerance` of the function; the nearer end if there is none. Regula falsi with halved ends
// (Illinois), about a dozen calls. The last call is at the result, so `f` may keep what belongs to
// it.
template <typename Function>
double solve(double low, double high, double wanted, double tolerance, Function&& f) {
  double f_low = f(low) - wanted;
  if (f_low >= 0) return low;
  double f_high = f(high) - wanted;
  if (f_high <= 0) return high;
  double middle = low;
  for (int i = 0, side = 0; i < 60; ++i) {
    middle = (low * f_high - high * f_low) / (f_high - f_low);
    const double f_middle = f(middle) - wanted;
    if (std::abs(f_middle) <= tolerance) break;
    if (f_middle < 0) {
      low = middle, f_low = f_middle;
      if (side == -1) f_high /= 2;
      side = -1;
    } else {
      high = middle, f_high = f_middle;
      if (side == 1) f_low /= 2;
      side = 1;
    }
  }
  return middle;
}

}  // namespace echocine::heart
