#pragma once
// Spatial variation of tissue backscatter: amplitude factors that stay with the scatterers, drawn
// at the reference phase. The coherent ratio is normalised without them, so the mean over seeds is
// the picture times their square.

#include <cstdint>
#include <memory>
#include <span>

#include "core/free_list.h"
#include "core/normal_field.h"
#include "motion/interior/motion_field.h"
#include "motion/surfaces/mesh_motion.h"
#include "plan/effect_plan.h"

namespace echocine {

// Log-normal backscatter with mean 1: exp(s n - s^2 / 2) with s = ln(10) / 10 times the standard
// deviation in dB, and n the sum of two normal fields over sqrt(2). One is isotropic. The other
// consists of layers across the beam, the visible orientation of tissue sheets. Their extent is
// `heterogeneity_coarse_m` at the probe's middle depth, and proportional to depth elsewhere.
class Heterogeneity {
 public:
  Heterogeneity(const SpeckleSettings& settings, const Probe& probe);
  double at(Vec3f place_m);

 private:
  Vec3f inLayers(Vec3f place_m) const;
  double layersAt(Vec3f place_m);

  double s_, extent_m_, per_thickness_, middle_m_, tangent_;
  bool linear_;
  bool full_turn_;
  NormalField fine_, layers_;
};

// A unit fibre within the wall: n is the unit vector from endo- to epicardium, a the long axis from
// base to apex, depth 0 at the endocardium to 1 at the epicardium. The helix angle varies linearly
// from h to -h; positive is a right-handed helix about a (Streeter et al., Circ. Res. 24, 339-347,
// 1969).
Vec3d fibreAt(Vec3d n, Vec3d a, double depth, double helix_angle_rad);

// Intensity from a fibre relative to one perpendicular to the beam: 10^(-A cos^2 / 10), A in dB,
// with the cosine of the angle between fibre and beam.
double fibreFactor(Vec3d fibre, Vec3d beam, double anisotropy_db);

class TissueStrength {
 public:
  // Fibres need a wall and a cavity of the left ventricle in the scene. Keeps no references.
  TissueStrength(const Scene& scene, const EffectPlan& plan, const MeshMotion& motion,
                 const MotionField& field);
  ~TissueStrength();

  // Amplitude factors at reference places of one group. Thread-safe.
  void amplitudes(std::span<const Vec3f> reference_m, std::uint16_t group, bool blood,
                  std::span<float> out) const;

 private:
  struct Wall;
  SpeckleSettings settings_;
  Probe probe_;
  std::unique_ptr<const Wall> wall_;  // none without fibres
  mutable FreeList<Heterogeneity> heterogeneities_;
};

}  // namespace echocine
