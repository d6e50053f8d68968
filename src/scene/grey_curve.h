#pragma once
// The grey map: from the position x in the dynamic range (0 black, 1 white) to the grey level.

#include "scene/scene.h"

namespace echocine {

// g(x) = c(x)^gamma, 0 to 1. With t = grey_toe and s = grey_shoulder, the slope of c is a
// trapezoid: 0 up to t, linear from t to 2t, constant up to 1 - s, linear to 0 at 1. So
//   c(x) = 0                          x <= t
//          a (x - t)^2 / (2 t)        t <= x <= 2 t
//          a (x - 3 t / 2)            2 t <= x <= 1 - s
//          1 - a (1 - x)^2 / (2 s)    1 - s <= x
//   a = 1 / (1 - 3 t / 2 - s / 2).
// c is monotone with a continuous slope; t = s = 0 gives c = x. The trapezoid is our choice: the
// shortest form of a sensitometric curve, toe, straight line and shoulder (Hurter and Driffield,
// J. Soc. Chem. Ind. 9, 455-469, 1890).
// Precondition: 2 t + s <= 1, which the ranges of the keys keep.
class GreyCurve {
 public:
  GreyCurve() = default;  // g = x
  explicit GreyCurve(const SignalSettings& signal);

  double at(double x) const;  // x is limited to 0..1
  // The x with at(x) = grey; t at grey 0, where every x <= t has it. 0 <= grey <= 1.
  double inverse(double grey) const;
  bool isIdentity() const { return toe_ == 0 && shoulder_ == 0 && gamma_ == 1; }

 private:
  double toe_ = 0, shoulder_ = 0, gamma_ = 1;
  double slope_ = 1;  // a
};

}  // namespace echocine
