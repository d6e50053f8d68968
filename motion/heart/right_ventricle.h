#pragma once
// The right ventricle: a crescent around the left one.

#include <vector>

#include "motion/heart/epicardium.h"
#include "motion/heart/left_ventricle.h"

namespace echocine::heart {

// Cavity at one instant. Its septal sheet follows the left ventricle's outer surface at a distance
// of half a millimetre; its free wall arches over that. The sheets meet along the two edges of the
// septum, below the pulmonary valve and at the apex.
class RightVentricle {
 public:
  static constexpr int kFrequency = 12;

  // `left` and `epicardium` are at the same instant; `ejected` is the fraction of its own stroke
  // volume. `epicardium` must outlive the ventricle.
  RightVentricle(const LeftVentricle& left, const Epicardium& epicardium, double ejected);

  // Sets the free wall's height over the septum.
  void arch(double height_m) { arch_m_ = height_m; }

  // Point for a direction of the unit sphere: z > 0 free wall, y = 1 apex.
  Vec3d cavityPoint(Vec3d direction) const;
  Vec3d wallPoint(Vec3d direction, double thickness_m) const;

  // The cavity's points without the arch of the free wall, for evaluation at several heights.
  struct Spoke {
    double cos_phi, sin_phi, z, septal_m, along, height;
  };
  // For directions of geodesicSphere(frequency). Precondition: kFrequency or twice that.
  std::vector<Spoke> spokes(int frequency) const;
  std::vector<Vec3d> cavityPoints(const std::vector<Spoke>& spokes) const;

  // Centre of the tricuspid valve.
  Vec3d ringCentre() const { return ring_centre_; }
  Vec3d ringFlow() const { return ring_flow_; }            // unit, normal to its plane
  double restingRingZ() const { return resting_ring_z_; }  // at end-diastole
  double ringRadius() const { return ring_radius_; }
  // Centre of the outflow's upper end, below the pulmonary valve.
  Vec3d outflow() const;

 private:
  double heightAlong(double t, double x, double inflow) const;

  const Epicardium* epicardium_;
  double arch_m_ = 0;
  double base_z_ = 0, apex_z_ = 0, tilt_m_ = 0, resting_ring_z_ = 0;
  double free_descent_m_ = 0;  // of the inflow's free wall, beyond that of the septum
  Vec3d ring_centre_, ring_flow_;
  double ring_radius_ = 0;
};

}  // namespace echocine::heart
