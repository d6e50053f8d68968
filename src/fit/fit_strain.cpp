#include "fit/fit_strain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "motion/heart/heart_cycle.h"
#include "motion/heart/left_ventricle.h"

namespace echocine::fit {

namespace {

constexpr std::size_t kStrainMeridians = 36, kStrainSteps = 24;

// A place of the cavity, the normal there in the plane of the meridian, and the wall over it.
struct WallOver {
  Vec3d at, normal;
  double radius_m, thickness_m;  // radius: distance from the long axis
};

WallOver wallOver(const heart::LeftVentricle& ventricle, double phi, double zeta) {
  constexpr double kAside = 1e-3;
  const double low = std::max(0.0, zeta - kAside), high = std::min(1.0, zeta + kAside);
  const Vec3d at = ventricle.cavityAt(phi, zeta),
              along = normalised(ventricle.cavityAt(phi, high) - ventricle.cavityAt(phi, low)),
              about{-std::sin(phi), std::cos(phi), 0};
  return {at, normalised(cross(about, along)), std::hypot(at.x, at.y),
          ventricle.wallThicknessAt(phi, zeta)};
}

// Share of the wall's section about the axis that lies inside a depth.
double sectionInside(const WallOver& wall, double depth_m) {
  const double r = wall.radius_m, outer = r + wall.thickness_m, middle = r + depth_m;
  return (middle * middle - r * r) / (outer * outer - r * r);
}

// By meridian and step, the share inside the middle of the wall at end-diastole. Muscle keeps its
// volume, so the same muscle has the same share later.
using MiddleShares = std::vector<double>;

double meridianLength(const heart::LeftVentricle& ventricle, MiddleShares& shares) {
  const bool first = shares.empty();
  double sum = 0;
  for (std::size_t m = 0; m < kStrainMeridians; ++m) {
    const double phi = 2 * std::numbers::pi * static_cast<double>(m) / kStrainMeridians;
    Vec3d before;
    for (std::size_t i = 0; i <= kStrainSteps; ++i) {
      const WallOver wall =
          wallOver(ventricle, phi, static_cast<double>(i) / static_cast<double>(kStrainSteps));
      if (first) shares.push_back(sectionInside(wall, 0.5 * wall.thickness_m));
      const double share = shares[m * (kStrainSteps + 1) + i], r = wall.radius_m,
                   outer = r + wall.thickness_m,
                   depth = std::sqrt(r * r + share * (outer * outer - r * r)) - r;
      const Vec3d here = wall.at + depth * wall.normal;
      if (i > 0) sum += length(here - before) / kStrainMeridians;
      before = here;
    }
  }
  return sum;
}

}  // namespace

std::vector<double> longitudinalStrains(const heart::Parameters& parameters,
                                        const std::vector<double>& phases) {
  const heart::Cycle cycle(parameters);
  heart::LeftVentricle ventricle(parameters);
  ventricle.contract(cycle.at(0).left);
  MiddleShares shares;
  const double first = meridianLength(ventricle, shares);
  std::vector<double> out;
  for (const double phase : phases) {
    ventricle.contract(cycle.at(phase).left);
    out.push_back(meridianLength(ventricle, shares) / first - 1);
  }
  return out;
}

double longitudinalStrainOf(const heart::Parameters& parameters) {
  return longitudinalStrains(parameters, {heart::Cycle(parameters).events().aortic_closes}).front();
}

}  // namespace echocine::fit
