#pragma once
// A leaflet of an atrioventricular valve: a sheet that hangs on the valve ring and keeps its
// length.

#include <vector>

#include "core/vec3.h"

namespace echocine::beating_heart {

inline constexpr int kLeafletRows = 7;     // hinge to free edge
inline constexpr int kLeafletColumns = 9;  // commissure to commissure

struct ValveRing {
  Vec3d centre_cm;
  Vec3d side, up, inflow;  // in the imaging plane, along y, from the atrium into the ventricle
  double radius_cm = 0;
};

struct Leaflet {
  double hinge = 1;          // +1 or -1: hinged on the positive or negative side of the ring
  double coaptation_cm = 0;  // where along `side` it meets the other leaflet
  double tent_cm = 0;        // how far its closed tip stands in the ventricle
  double open_rad = 0;       // angle between the open leaflet and the ring's plane
};

// The sheet's points, row after row from the hinge, for an opening from 0 (closed) to 1 (wide
// open).
std::vector<Vec3d> leafletPoints(const ValveRing& ring, const Leaflet& leaflet, double opening);

}  // namespace echocine::beating_heart
