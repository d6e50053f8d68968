#pragma once
// Valve leaflets: sheets that hang on a ring and keep their length as they open.

#include <vector>

#include "core/vec3.h"

namespace echocine::heart {

inline constexpr int kLeafletRows = 7;     // hinge to free edge
inline constexpr int kLeafletColumns = 9;  // commissure to commissure

struct ValveRing {
  Vec3d centre;
  Vec3d side, up;  // span the ring's plane, unit; angles go from side to up
  Vec3d flow;      // unit, the way the blood goes
  double radius_m = 0;
};

// How a leaflet moves. Angles are between the leaflet and the ring's plane, against the flow
// negative.
struct LeafletMotion {
  double open_rad;         // wide open
  double closed_bend_rad;  // by which the closed leaflet turns downstream from hinge to edge
  double open_bend_rad;    // the same of the open one
};

// One of a pair that meets along a line: hinged on the ring around `angle_rad`; the line crosses
// the ring's plane `coaptation_m` from the centre towards that side, its middle `tent_m`
// downstream. Points row after row from the hinge, for an opening from 0 (closed) to 1 (wide open).
std::vector<Vec3d> pairedLeaflet(const ValveRing& ring, double angle_rad, double coaptation_m,
                                 double tent_m, const LeafletMotion& motion, double opening);

// One of three cusps that meet in a star: hinged on the third of the ring around `angle_rad`, its
// closed middle `height_m` downstream.
std::vector<Vec3d> starCusp(const ValveRing& ring, double angle_rad, double height_m,
                            const LeafletMotion& motion, double opening);

}  // namespace echocine::heart
