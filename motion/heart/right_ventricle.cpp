#include "motion/heart/right_ventricle.h"

#include <algorithm>
#include <cmath>

#include "core/monotone_cubic.h"
#include "motion/heart/units.h"

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
constexpr double kTricuspidExcursion = 1.15;  // TAPSE over MAPSE; our choice
constexpr double kRightApexRise = 0.05;

}  // namespace

RightVentricle::RightVentricle(const LeftVentricle& left, const Epicardium& epicardium,
                               double ejected)
    : epicardium_(&epicardium) {
  const double l = left.length();
  const double descent_m = kTricuspidExcursion * left.ringZ();
  base_z_ = kBase * l + descent_m * 0.8;
  apex_z_ = (kApex - kRightApexRise * ejected) * l;
  tilt_m_ = kTilt * l;
  resting_ring_z_ = 0.155 * l;
  const double ring_z = resting_ring_z_ + descent_m;
  ring_radius_ = (0.19 - 0.025 * ejected) * l;
  constexpr double kRingPhi = 181 * kDegree;
  const double ring_r = epicardium.radius(kRingPhi, ring_z) + 0.85 * ring_radius_;
  ring_centre_ = {ring_r * std::cos(kRingPhi), ring_r * std::sin(kRingPhi), ring_z};
}

Vec3d RightVentricle::cavityPoint(Vec3d direction) const {
  return wallPoint(direction, 0);
}

// Grown along the sphere's direction, read as (about the axis, along it, away from it): near enough
// to the normal, and no thickness folds it.
Vec3d RightVentricle::wallPoint(Vec3d direction, double thickness_m) const {
  const double t = 0.5 * (1 + direction.y);
  const double phi_rad = (middle()(t) + halfWidth()(t) * direction.x) * kDegree;
  // The inflow's base stands nearer the apex than the outflow's.
  const double z = std::lerp(base_z_, apex_z_, t) + tilt_m_ * direction.x * (1 - t);
  // 0 on the septal sheet, rising over the free wall, the turn between them rounded.
  constexpr double kRim = 0.3;
  const double height = 0.5 * (direction.z + std::hypot(direction.z, kRim));
  const double r =
      epicardium_->radius(phi_rad, z) + kSeptalGap_m + arch_m_ * archAlong()(t) * height;
  const double outer_phi_rad = phi_rad + thickness_m / r * direction.x;
  const double outer_r = r + thickness_m * direction.z;
  return {outer_r * std::cos(outer_phi_rad), outer_r * std::sin(outer_phi_rad),
          z + thickness_m * direction.y};
}

Vec3d RightVentricle::outflow() const {
  return cavityPoint(normalised(Vec3d{-0.22, -0.85, 0.48}));
}

}  // namespace echocine::heart
