#pragma once
// A chamber or its outer surface: an ellipsoid whose valve end is cut off and rounded, on a
// slightly bent axis. World coordinates in cm: x to the left ventricle, y out of the imaging plane,
// z away from the probe.

#include <vector>

#include "core/vec3.h"
#include "examples/beating_heart/control_mesh.h"

namespace echocine::beating_heart {

struct Chamber {
  Vec3d apex_cm;              // the end away from the valve; apex and ring lie in the plane y = 0
  Vec3d ring_cm;              // centre of the valve ring
  double beyond_ring_cm = 0;  // the cap reaches this far through the ring
  double widest = 0.6;        // where the chamber is widest, as a share of its length from the apex
  double radius_cm = 0;       // there, in the imaging plane
  double ring_radius_cm = 0;
  double aspect = 1;  // radius along y over radius in the imaging plane
  double bow_cm = 0;  // how far the axis is bent towards its side axis
  double wrap_per_cm =
      0;  // shift towards the side axis per square of y: a chamber wrapped round another
  double apex_exponent = 2;  // 2 is an ellipsoid, more is blunter
  double cap_exponent = 4;
  double twist_rad = 0;  // of the apex about the axis, against the ring
};

// A chamber with everything that follows from its measures.
class ChamberSurface {
 public:
  explicit ChamberSurface(const Chamber& chamber);

  // The point that stands for a direction of the unit sphere, (0, 0, -1) being the apex.
  Vec3d at(Vec3d direction) const;

  // `point`, moved away from the axis until it is no deeper than `depth_cm` under this surface. The
  // bend from untouched to moved is rounded.
  Vec3d pushedOut(Vec3d point, double depth_cm) const;

 private:
  struct Meridian {
    double along, radius;
  };
  double radiusAt(double along_cm) const;
  double bowAt(double along_cm) const;

  Chamber chamber_;
  Vec3d centre_, side_, up_{0, 1, 0}, axis_;
  double to_apex_cm_ = 0, to_cap_cm_ = 0;
  double taper_ = 0;                // narrows the valve half until it passes through the ring
  std::vector<Meridian> meridian_;  // evenly spaced by arc length, apex to cap
};

// The surface's points for every direction of a sphere mesh.
std::vector<Vec3d> pointsOf(const ChamberSurface& surface, const SphereMesh& sphere);

}  // namespace echocine::beating_heart
