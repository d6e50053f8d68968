#pragma once
// The outer surface of the left ventricle as its neighbours feel it.

#include <vector>

#include "motion/heart/left_ventricle.h"

namespace echocine::heart {

// Distance of the wall's outer surface from the long axis, tabled.
class Epicardium {
 public:
  explicit Epicardium(const LeftVentricle& ventricle);

  // Metres, at an angle about the axis and a height z; beyond the table's ends the end values.
  double radius(double phi_rad, double z) const;
  // `point`, moved away from the axis until it stands at least `gap_m` outside. The bend from
  // untouched to moved is rounded.
  Vec3d pushedOut(Vec3d point, double gap_m) const;

 private:
  double low_z_ = 0, high_z_ = 0;
  std::vector<double> radius_m_;  // a row of heights for each angle
};

}  // namespace echocine::heart
