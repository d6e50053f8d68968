#pragma once
// Sections of a parametric left ventricle across its long axis.

#include <cmath>
#include <numbers>

#include "motion/heart/left_ventricle.h"

namespace echocine::support {

// Equivalent diameter of the cavity's section at a height (0: ring, 1: apex), m: of the circle with
// its area.
inline double sectionDiameter(const heart::LeftVentricle& left, double zeta) {
  constexpr int kSides = 720;
  double double_area = 0;
  Vec3d before = left.cavityAt(0, zeta);
  for (int i = 1; i <= kSides; ++i) {
    const Vec3d p = left.cavityAt(2 * std::numbers::pi * i / kSides, zeta);
    double_area += before.x * p.y - before.y * p.x;
    before = p;
  }
  return std::sqrt(2 * double_area / std::numbers::pi);
}

}  // namespace echocine::support
