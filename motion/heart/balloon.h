#pragma once
// A chamber attached to a ring: an outline swept around a straight axis.

#include <span>
#include <vector>

#include "core/vec3.h"
#include "motion/heart/four_points.h"
#include "motion/heart/meridian.h"

namespace echocine::heart {

// A direction of the unit sphere in terms of an outline. Computing it takes longer than placing the
// point, so it is cached.
struct Bearing {
  double zeta, rho, cos_azimuth, sin_azimuth;
};
Bearing bearingOf(const Meridian& outline, Vec3d direction);

// Surface points for directions of the unit sphere, with z away from the ring. The axis runs from
// `ring` (zeta 0) to `roof` (zeta 1). Radii are the outline's times the length of the axis.
struct Balloon {
  const Meridian* outline = nullptr;
  Vec3d ring, roof;
  Vec3d side;            // roughly; its component across the axis is the first cross direction
  double aspect = 1;     // sqrt of (extent along `side` / extent across it)
  double girth = 1;      // factor of the radii away from the ring
  double ring_zone = 0;  // zeta below which `girth` fades to 1; 0: it applies everywhere
  Vec3d bow;             // displacement of the axis at mid-length, 0 at both ends

  std::vector<Vec3d> points(std::span<const Bearing> bearings) const;  // of its own outline
  // Moves each point away from the axis until it is at least `gap_m` outside.
  void pushOut(double gap_m, std::vector<Vec3d>& points) const;
  // Centre of the section at zeta, and its radius in the direction of a point.
  Vec3d centre(double zeta) const;
  double radiusTowards(Vec3d point, double zeta) const;

 private:
  struct Axes {
    double length_m;
    Vec3d along, u, v;  // u is the component of side across the axis
  };
  Axes axes() const;
  double radius(double zeta, double rho, double length_m) const;
  Doubles4 radius(Doubles4 zeta, Doubles4 rho, double length_m) const;
  FourPoints centre(Doubles4 zeta) const;
  FourPoints pushedOut(const FourPoints& p, double gap_m, const Axes& a) const;
};

}  // namespace echocine::heart
