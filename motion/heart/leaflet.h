#pragma once
// Valve leaflets: sheets attached to a ring that keep their length as they open.

#include <vector>

#include "core/vec3.h"

namespace echocine::heart {

inline constexpr int kLeafletRows = 7;     // hinge to free edge
inline constexpr int kLeafletColumns = 9;  // commissure to commissure

struct ValveRing {
  Vec3d centre;
  Vec3d side, up;  // unit, span the ring's plane; angles run from side to up
  Vec3d flow;      // unit, direction of blood flow
  double radius_m = 0;
};

// Motion of a leaflet. Angles are between the leaflet and the ring's plane, negative against the
// flow.
struct LeafletMotion {
  double open_rad;         // fully open
  double closed_bend_rad;  // downstream bend from hinge to edge of the closed leaflet
  double open_bend_rad;    // the same for the open leaflet
};

// One of a pair of leaflets that meet along a line. It is hinged on the ring around `angle_rad`.
// The line crosses the ring's plane `coaptation_m` from the centre towards that side; its midpoint
// is `tent_m` downstream. Points row by row from the hinge, for an opening from 0 (closed) to 1
// (fully open).
std::vector<Vec3d> pairedLeaflet(const ValveRing& ring, double angle_rad, double coaptation_m,
                                 double tent_m, const LeafletMotion& motion, double opening);

// One of three cusps that meet in a star: hinged on the third of the ring around `angle_rad`. The
// closed cusps meet `height_m` downstream.
std::vector<Vec3d> starCusp(const ValveRing& ring, double angle_rad, double height_m,
                            const LeafletMotion& motion, double opening);

}  // namespace echocine::heart
