#pragma once
// A chamber that hangs on a ring: an outline carried round a straight axis.

#include <span>
#include <vector>

#include "core/vec3.h"
#include "motion/heart/meridian.h"

namespace echocine::heart {

// A direction of the unit sphere as an outline has it. To look it up takes longer than to place it.
struct Bearing {
  double zeta, rho, cos_azimuth, sin_azimuth;
};
Bearing bearingOf(const Meridian& outline, Vec3d direction);

// Surface points for directions of the unit sphere, z being the end away from the ring. The axis
// runs from `ring` (zeta 0) to `roof` (zeta 1); radii are the outline's times the axis' length.
struct Balloon {
  const Meridian* outline = nullptr;
  Vec3d ring, roof;
  Vec3d side;            // roughly; the first cross direction is its part across the axis
  double aspect = 1;     // sqrt of the extent along `side` over the other one
  double girth = 1;      // factor of the radii well away from the ring
  double ring_zone = 0;  // zeta below which `girth` fades out; 0: it holds everywhere
  Vec3d bow;             // shift of the axis at mid-length, fading to none at both ends

  std::vector<Vec3d> points(std::span<const Bearing> bearings) const;  // of its own outline
  // Moves each point away from the axis until it is at least `gap_m` outside.
  void pushOut(double gap_m, std::vector<Vec3d>& points) const;

 private:
  struct Axes {
    double length_m;
    Vec3d along, u, v;  // u is side's part across the axis
  };
  Axes axes() const;
  double radius(double zeta, double rho, double length_m) const;
  Vec3d centre(double zeta) const;
  Vec3d pushedOut(Vec3d p, double gap_m, const Axes& a) const;
};

}  // namespace echocine::heart
