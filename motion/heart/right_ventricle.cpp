#include "motion/heart/right_ventricle.h"

#include <algorithm>
#include <cmath>

#include "core/monotone_cubic.h"
#include "motion/heart/heart_units.h"

namespace echocine::heart {
namespace {

constexpr double kSeptalGap_m = 5e-4;

// Over the height from base (0) to apex (1): the crescent's middle and half width about the left
// ventricle's axis, deg; the width is that before the disc's rim rounds it off. Our choice, drawn
// after one heart fitted to cine MR.
const MonotoneCubic& middle() {
  static const MonotoneCubic table(
      {{0, 118}, {0.07, 124}, {0.16, 140}, {0.26, 156}, {0.53, 171}, {0.8, 182}, {1, 190}});
  return table;
}
const MonotoneCubic& halfWidth() {
  static const MonotoneCubic table(
      {{0, 130}, {0.07, 120}, {0.16, 95}, {0.26, 80}, {0.53, 56}, {0.8, 56}, {0.95, 80}, {1, 95}});
  return table;
}

// Height of the free wall, as a share of its height at mid-length.
const MonotoneCubic& archAlong() {
  static const MonotoneCubic table(
      {{0, 1.1}, {0.3, 1.03}, {0.5, 1}, {0.8, 0.84}, {0.9, 0.7}, {1, 0.55}});
  return table;
}

// Shares of the left ventricle's length.
constexpr double kBase = -0.07, kApex = 0.93, kTilt = 0.256;
constexpr double kTricuspidExcursion = 1.15;  // of the ring's centre over MAPSE; our choice
constexpr double kRightApexRise = 0.05;

// The free wall of the inflow shortens more than the septum, so the base tilts with ejection. Its
// extra descent over MAPSE, and the limit of that, are our choice: TAPSE is 17 mm or more in health
// (Lang et al., J. Am. Soc. Echocardiogr. 28, 1-39, 2015), 24.0 +- 3.5 mm in men and 23.2 +- 3.0 mm
// in women (Ferrara et al., Int. J. Cardiol. 223, 736-743, 2016).
constexpr double kFreeWallExcursion = 1.5, kFreeWallLimit = 0.4;
constexpr double kInflow_rad = 185 * kDegree;

// Properties of a direction that are independent of dials and time.
struct RightPlace {
  double x, t, phi_rad, along, height;  // t from base to apex
  double inflow;                        // 1 on the free wall of the inflow, 0 at septum, outflow
};

RightPlace rightPlaceOf(Vec3d direction) {
  const double t = 0.5 * (1 + direction.y);
  // 0 on the septal sheet, rising over the free wall, with a smooth transition.
  constexpr double kRim = 0.3;
  const double height = 0.5 * (direction.z + std::hypot(direction.z, kRim));
  const double phi_rad = (middle()(t) + halfWidth()(t) * direction.x) * kDegree;
  const double facing = 0.5 * (1 + std::cos(phi_rad - kInflow_rad));
  return {direction.x, t, phi_rad, archAlong()(t), height, height * facing * facing};
}

struct TurnedPlace {
  RightPlace place;
  double cos_phi, sin_phi;
};

std::vector<TurnedPlace> placesOf(int frequency) {
  std::vector<TurnedPlace> places;
  for (const Vec3d direction : geodesicSphere(frequency).directions) {
    const RightPlace place = rightPlaceOf(direction);
    places.push_back({place, std::cos(place.phi_rad), std::sin(place.phi_rad)});
  }
  return places;
}

}  // namespace

RightVentricle::RightVentricle(const LeftVentricle& left, const Epicardium& epicardium,
                               double ejected)
    : epicardium_(&epicardium) {
  const double l = left.length();
  const double descent_m = kTricuspidExcursion * left.ringZ();
  base_z_ = kBase * l + descent_m * 0.8;
  apex_z_ = (kApex - kRightApexRise * ejected) * l;
  tilt_m_ = kTilt * l;
  const double free_m = kFreeWallExcursion * left.ringZ(), limit_m = kFreeWallLimit * l;
  free_descent_m_ = free_m / std::hypot(1, free_m / limit_m);
  resting_ring_z_ = 0.155 * l;
  const double ring_z = resting_ring_z_ + descent_m;
  ring_radius_ = (0.19 - 0.025 * ejected) * l;
  constexpr double kRingPhi = 181 * kDegree;
  const double ring_r = epicardium.radius(kRingPhi, ring_z) + 0.85 * ring_radius_;
  ring_centre_ = {ring_r * std::cos(kRingPhi), ring_r * std::sin(kRingPhi), ring_z};
  constexpr double kRestingSlope = 0.12, kFreeWallAtRing = 0.55;  // of the ring's plane; our choice
  const double slope = kRestingSlope + kFreeWallAtRing * free_descent_m_ / (2 * ring_radius_);
  ring_flow_ = normalised(Vec3d{slope, 0.05, 1});
}

Vec3d RightVentricle::cavityPoint(Vec3d direction) const {
  return wallPoint(direction, 0);
}

// Dilated along the sphere's direction, interpreted as (about the axis, along it, away from it):
// close to the normal, and free of folds for any thickness.
Vec3d RightVentricle::wallPoint(Vec3d direction, double thickness_m) const {
  const RightPlace at = rightPlaceOf(direction);
  const double phi_rad = at.phi_rad, z = heightAlong(at.t, at.x, at.inflow);
  const double r = epicardium_->radius(phi_rad, z) + kSeptalGap_m + arch_m_ * at.along * at.height;
  const double outer_phi_rad = phi_rad + thickness_m / r * direction.x;
  const double outer_r = r + thickness_m * direction.z;
  return {outer_r * std::cos(outer_phi_rad), outer_r * std::sin(outer_phi_rad),
          z + thickness_m * direction.y};
}

// The inflow's base is closer to the apex than the outflow's.
double RightVentricle::heightAlong(double t, double x, double inflow) const {
  return std::lerp(base_z_, apex_z_, t) + (tilt_m_ * x + free_descent_m_ * inflow) * (1 - t);
}

std::vector<RightVentricle::Spoke> RightVentricle::spokes(int frequency) const {
  static const std::vector<TurnedPlace> coarse = placesOf(kFrequency),
                                        fine = placesOf(2 * kFrequency);
  std::vector<Spoke> spokes;
  spokes.reserve(fine.size());
  for (const auto& [place, cos_phi, sin_phi] : frequency == kFrequency ? coarse : fine) {
    const double z = heightAlong(place.t, place.x, place.inflow);
    spokes.push_back({cos_phi, sin_phi, z, epicardium_->radius(place.phi_rad, z) + kSeptalGap_m,
                      place.along, place.height});
  }
  return spokes;
}

std::vector<Vec3d> RightVentricle::cavityPoints(const std::vector<Spoke>& spokes) const {
  std::vector<Vec3d> points;
  points.reserve(spokes.size());
  for (const Spoke& at : spokes) {
    const double r = at.septal_m + arch_m_ * at.along * at.height;
    points.push_back({r * at.cos_phi, r * at.sin_phi, at.z});
  }
  return points;
}

Vec3d RightVentricle::outflow() const {
  return cavityPoint(normalised(Vec3d{-0.22, -0.85, 0.48}));
}

}  // namespace echocine::heart
