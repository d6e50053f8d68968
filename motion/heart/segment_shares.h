#pragma once
// Regional wall motion: weights of the segments at a place of the left ventricle.

#include <array>

#include "motion/heart/parameters.h"

namespace echocine::heart {

// Weights of the 17 segments at a place of the wall; they sum to 1. phi_rad: about the long axis, 0
// lateral, pi/2 anterior; zeta: 0 at the mitral ring, 1 at the apex. Neighbours blend smoothly; at
// its centre a segment has weight 1.
std::array<double, kSegments> segmentShares(double phi_rad, double zeta);

// The centre of a segment, counted from 0.
struct SegmentPlace {
  double phi_rad, zeta;
};
SegmentPlace segmentCentre(int segment);

}  // namespace echocine::heart
