#pragma once
// The outline of a chamber along its axis, for balloon-like surfaces.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/monotone_cubic.h"
#include "core/vec3.h"

namespace echocine::heart {

// A meridian: radius rho over axial coordinate zeta, both relative to a length, closed at both
// ends. Parametrised by arc length from its high-zeta end (0) to its low-zeta end (1), so that a
// sphere mesh mapped onto it has well-shaped triangles.
class Meridian {
 public:
  struct Point {
    double zeta, rho;
  };

  // Knots (zeta, rho^2), zeta ascending, rho 0 at both ends. Squares are used because rho^2 is
  // smooth at a rounded end, and rho is not.
  explicit Meridian(std::vector<std::pair<double, double>> squares);

  Point at(double share) const;
  double rhoAt(double zeta) const { return std::sqrt(std::max(0.0, square_(zeta))); }
  // Volume of the surface of revolution, relative to the cube of the length.
  double volume() const { return volume_; }
  double lowest() const { return points_.back().zeta; }
  double widest() const { return widest_; }  // largest rho

 private:
  MonotoneCubic square_;
  std::vector<Point> points_;  // evenly spaced by arc length
  double volume_ = 0, widest_ = 0;
};

// The parameter of a meridian for a direction of the unit sphere: (0, 0, 1) is its high-zeta end,
// 0; the other end is 1; linear in the angle.
inline double shareOf(Vec3d direction) {
  return std::acos(std::clamp(direction.z, -1.0, 1.0)) / std::numbers::pi;
}

}  // namespace echocine::heart
