#pragma once
// Directions from the middle of a structure's boundary, by which pieces of boundary are summed.

#include <vector>

#include "fit/model_plane.h"

namespace echocine::fit {

inline constexpr int kSides = 24;  // our choice: 5 to 10 mm of a ventricle's wall

// Middle of a structure's boundary in a frame, weighted by length.
struct BoundaryMiddle {
  double x_m = 0, z_m = 0, length_m = 0;
};
// By structure.
std::vector<BoundaryMiddle> middlesOf(const ModelFrame& frame, std::size_t structures);

// The two nearest directions of a piece, with linear shares: continuous in its place.
struct SideShares {
  std::size_t first = 0, second = 0;
  double share = 0;  // of the second
};
SideShares sidesOf(const BoundaryPoint& piece, const BoundaryMiddle& middle);

}  // namespace echocine::fit
