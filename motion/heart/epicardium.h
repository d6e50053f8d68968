#pragma once
// The outer surface of the left ventricle, for its neighbours.

#include <vector>

#include "core/lanes.h"
#include "motion/heart/left_ventricle.h"

namespace echocine::heart {

// Distance of the wall's outer surface from the long axis, tabulated.
class Epicardium {
 public:
  explicit Epicardium(const LeftVentricle& ventricle);

  // In m, at an angle about the axis and a height z; constant beyond the ends of the table.
  double radius(double phi_rad, double z) const {
    return radius(Doubles4{} + phi_rad, Doubles4{} + z)[0];
  }
  // Moves each point away from the axis until it is at least `gap_m` outside, with a smooth
  // transition.
  void pushOut(double gap_m, std::vector<Vec3d>& points) const;

 private:
  Doubles4 radius(Doubles4 phi_rad, Doubles4 z) const;

  double low_z_ = 0, high_z_ = 0;
  std::vector<double> radius_m_;  // one row of heights per angle
};

}  // namespace echocine::heart
