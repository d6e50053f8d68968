#pragma once
// How strongly tissue scatters back from place to place: factors of amplitude that scatterers keep,
// drawn at the reference phase. The coherent ratio is normalised without them, so the mean over
// seeds is the picture times their square.

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "motion/interior/motion_field.h"
#include "motion/mesh_motion.h"
#include "scene/effect_plan.h"

namespace echocine {

// A standard normal field that is smooth over `scale_m`: normals hashed on a lattice of that
// spacing, blended by smooth weights and divided by the root of their squares' sum, so that its
// variance is 1 at every place. Fast for places near each other: it remembers cells. One thread at
// a time.
class NormalField {
 public:
  NormalField(double scale_m, std::uint64_t seed) : scale_m_(scale_m), seed_(seed) {}
  double at(Vec3f place_m);

 private:
  struct Cell {
    std::array<std::int64_t, 3> node;
    bool known = false;
    std::array<double, 8> normals;
  };
  const Cell& cellOf(const std::array<std::int64_t, 3>& node);

  double scale_m_;
  std::uint64_t seed_;
  std::array<Cell, 64> cells_{};  // by their nodes' last two bits. Our choice
};

// Log-normal backscatter with mean 1: exp(s n - s^2 / 2) with s = ln(10) / 10 times the standard
// deviation in dB, and n the sum of the fine and the coarse field over sqrt(2).
class Heterogeneity {
 public:
  explicit Heterogeneity(const SpeckleSettings& settings);
  double at(Vec3f place_m);

 private:
  double s_;
  NormalField fine_, coarse_;
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
