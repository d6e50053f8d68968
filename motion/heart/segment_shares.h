#pragma once
// Regional wall motion: where on the left ventricle which segment has how much to say.

#include <array>

#include "motion/heart/parameters.h"

namespace echocine::heart {

// Shares of the 17 segments at a place of the wall, which sum to 1. phi_rad: about the long axis, 0
// lateral, pi/2 anterior; zeta: 0 at the mitral ring, 1 at the apex. Neighbours blend into each
// other smoothly, each ruling alone at its centre.
std::array<double, kSegments> segmentShares(double phi_rad, double zeta);

// The middle of a segment, counted from 0.
struct SegmentPlace {
  double phi_rad, zeta;
};
SegmentPlace segmentCentre(int segment);

}  // namespace echocine::heart
