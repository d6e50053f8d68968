#pragma once
// A chamber that hangs on a ring: an outline carried round a straight axis.

#include "core/vec3.h"
#include "motion/heart/meridian.h"

namespace echocine::heart {

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

  Vec3d point(Vec3d direction) const;
  Vec3d normal(Vec3d direction) const;  // unit, outward
  // `p`, moved away from the axis until it is at least `gap_m` outside.
  Vec3d pushedOut(Vec3d p, double gap_m) const;

 private:
  struct Axes {
    double length_m;
    Vec3d along, u, v;  // u is side's part across the axis
  };
  Axes axes() const;
  double radius(double zeta, double rho, double length_m) const;
  Vec3d centre(double zeta) const;
};

}  // namespace echocine::heart
