#include "scene/grey_curve.h"

#include <algorithm>
#include <cmath>

namespace echocine {

GreyCurve::GreyCurve(const SignalSettings& signal)
    : toe_(signal.grey_toe),
      shoulder_(signal.grey_shoulder),
      gamma_(signal.grey_gamma),
      slope_(1 / (1 - 1.5 * toe_ - 0.5 * shoulder_)) {}

double GreyCurve::at(double x) const {
  if (x >= 1) return 1;  // to the last bit
  const double inside = std::max(x, 0.0), below_white = 1 - inside;
  double c = slope_ * (inside - 1.5 * toe_);
  if (inside < 2 * toe_) {
    const double over = std::max(inside - toe_, 0.0);
    c = slope_ * over * over / (2 * toe_);
  } else if (below_white < shoulder_) {
    c = 1 - slope_ * below_white * below_white / (2 * shoulder_);
  }
  return std::pow(std::clamp(c, 0.0, 1.0), gamma_);
}

double GreyCurve::inverse(double grey) const {
  const double c = std::pow(std::clamp(grey, 0.0, 1.0), 1 / gamma_);
  if (c < slope_ * toe_ / 2) return toe_ + std::sqrt(2 * toe_ * c / slope_);
  if (1 - c < slope_ * shoulder_ / 2) return 1 - std::sqrt(2 * shoulder_ * (1 - c) / slope_);
  return c / slope_ + 1.5 * toe_;
}

}  // namespace echocine
