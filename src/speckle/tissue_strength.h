#pragma once
// How strongly tissue scatters back from place to place: factors of amplitude that scatterers keep,
// drawn at the reference phase. The coherent ratio is normalised without them, so the mean over
// seeds is the picture times their square.

#include <cstdint>
#include <memory>
#include <span>

#include "core/normal_field.h"
#include "motion/interior/motion_field.h"
#include "motion/surfaces/mesh_motion.h"
#include "plan/effect_plan.h"

namespace echocine {

// Log-normal backscatter with mean 1: exp(s n - s^2 / 2) with s = ln(10) / 10 times the standard
// deviation in dB, and n the sum of two normal fields over sqrt(2). One is alike in all directions.
// The other one's are layers that lie across the beam: of all sheets of tissue those are seen. They
// reach `heterogeneity_coarse_m` at the probe's middle depth, elsewhere by the angle.
class Heterogeneity {
 public:
  Heterogeneity(const SpeckleSettings& settings, const Probe& probe);
  double at(Vec3f place_m);

 private:
  Vec3f inLayers(Vec3f place_m) const;

  double s_, extent_m_, per_thickness_, middle_m_, tangent_;
  bool linear_;
  NormalField fine_, layers_;
};

// A unit fibre within the wall: n the unit way from endo- to epicardium, a the long axis from base
// to apex, depth 0 at the endocardium to 1 at the epicardium. Its helix angle goes evenly from h to
// -h; positive is a right-handed helix about a (Streeter et al., Circ. Res. 24, 339-347, 1969).
Vec3d fibreAt(Vec3d n, Vec3d a, double depth, double helix_angle_rad);

// What a fibre sends back against one that lies across the beam: 10^(-A cos^2 / 10) of intensity,
// A in dB, with the cosine of the angle between fibre and beam.
double fibreFactor(Vec3d fibre, Vec3d beam, double anisotropy_db);

class TissueStrength {
 public:
  // Fibres where the scene has a wall and a cavity of the left ventricle. Keeps no references.
  TissueStrength(const Scene& scene, const EffectPlan& plan, const MeshMotion& motion,
                 const MotionField& field);
  ~TissueStrength();

  // Factors of amplitude at reference places of one group. Thread-safe.
  void amplitudes(std::span<const Vec3f> reference_m, std::uint16_t group, bool blood,
                  std::span<float> out) const;

 private:
  struct Wall;
  SpeckleSettings settings_;
  Probe probe_;
  std::unique_ptr<const Wall> wall_;  // none without fibres
};

}  // namespace echocine
