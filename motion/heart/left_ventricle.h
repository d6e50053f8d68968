#pragma once
// The left ventricle: cavity and wall at one instant.
//
// Heart coordinates, metres: origin at the centre of the mitral ring at end-diastole, z along the
// long axis towards the apex, x from the septum to the lateral wall, y towards the anterior wall.
// About the axis phi = atan2(y, x): 0 lateral, 60 deg anterior, 120 anteroseptal, 180 inferoseptal,
// 240 inferior, 300 inferolateral.

#include <array>
#include <optional>
#include <vector>

#include "core/vec3.h"
#include "motion/heart/control_mesh.h"
#include "motion/heart/parameters.h"
#include "motion/heart/volume_gauge.h"
#include "motion/heart/wall_place.h"

namespace echocine::heart {

// State of the left ventricle within its beat.
struct Contraction {
  double ejected = 0;  // fraction of the stroke volume, 0 at end-diastole, 1 at end-systole
  std::array<double, kSegments> segments{};  // inward motion; 1: a healthy segment at end-systole
};

// Width over length of the cavity at end-diastole: the dial, or what the dial lv-length makes it.
double sphericityOf(const Parameters& parameters);

class LeftVentricle {
 public:
  // Its surfaces' meshes are geodesicSphere(kFrequency).
  static constexpr int kFrequency = kWallFrequency;

  // At end-diastole. Throws SceneError if no contraction reaches the end-systolic volume.
  explicit LeftVentricle(const Parameters& parameters);

  // Ejection fraction of a ventricle whose healthy segments contract as for the dialled one, and
  // whose other segments contract by their own amplitude; the dialled one if all are healthy.
  // Throws like the constructor.
  static double ejectionFractionOf(const Parameters& parameters);

  // Sets the shape: the cavity encloses edv - ejected * stroke volume; the wall keeps its
  // end-diastolic volume. Throws SceneError if that is impossible.
  void contract(const Contraction& contraction);

  double length() const { return length_; }  // at end-diastole
  double ringZ() const { return ring_z_; }   // of the mitral ring's plane
  double apexZ() const { return apex_z_; }
  double twist() const { return twist_rad_; }  // of the apex relative to the base

  // Points for a direction of the unit sphere; (0, 0, 1) is the apex.
  Vec3d cavityPoint(Vec3d direction) const;
  Vec3d wallPoint(const WallPlace& at) const;
  // Points for all directions of geodesicSphere(kFrequency).
  std::vector<Vec3d> cavityPoints() const;
  std::vector<Vec3d> wallPoints() const;

  // A place on the cavity's surface by its angle about the axis and zeta, 0 at the mitral ring and
  // 1 at the apex; and the wall thickness there.
  Vec3d cavityAt(double phi_rad, double zeta) const;
  double wallThicknessAt(double phi_rad, double zeta) const;

 private:
  struct Turned {                            // a place at one instant
    double cos_phi, sin_phi, inward, wider;  // wider: by the taper
    double thicker;                          // wall, by SectionShape
  };
  struct Grown {  // the wall over a place, before `thickening_`
    Vec3d from, normal;
    double thickness_m;
  };
  void set(const Contraction& contraction);
  Turned turnedOf(const WallPlace& at) const;
  WallPlace untwisted(double phi_rad, double zeta) const;
  double widerAt(double lean) const;
  double thickerAt(const WallPlace& at) const;
  double radius(const WallPlace& at, const Turned& turned) const;
  Vec3d placed(const WallPlace& at, const Turned& turned) const;
  double unscaledThickness(const WallPlace& at, const Turned& turned) const;
  Grown grown(const WallPlace& at, const Turned& turned) const;
  std::vector<Grown> grownPlaces() const;
  double cavityVolume() const;

  Parameters parameters_;
  double length_ = 0, girth_ = 1;  // of the table's radii
  double taper_ = 0;               // of the outline
  double gradient_ = 0;            // of the inward motion, as the taper of the radii
  double ring_z_ = 0, apex_z_ = 0, twist_rad_ = 0;
  double strain_ = 0, correction_ = 0, thickening_ = 1;
  double edv_m3_ = 0, wall_m3_ = 0;
  Contraction contraction_;
  std::vector<Turned> turned_;  // meshPlaces()
  std::optional<VolumeGauge> cavity_gauge_, outer_gauge_;
};

}  // namespace echocine::heart
