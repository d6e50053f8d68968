#pragma once
// Where another probe's view lies in the real picture: a coarse registration for loops that hardly
// resemble one another.

#include "compare/space_alignment.h"

namespace echocine::compare {

// Limits of the search, our choice: how far hearts lie from where others do under a probe held
// alike. No scale: lengths are known, or sectors are taken to be of one depth.
inline constexpr double kSearchShift = 0.15;       // of the real sector's outer radius, each way
inline constexpr double kSearchRotation_deg = 10;  // about the apex, each way

// The shift and rotation of largest c G (Eqs. 1 and 2) between the loops' means, which need no
// pairing in time: all on a lattice of 3 % of the radius and 10/3 degrees, then the best few by
// steps that halve down to 0.2 %. Placements that leave under half of the common area in sight are
// not looked at. Used when c G gains 0.02 (our choice) over the sectors as they are.
SpaceAlignment searchView(const BeamGrid& grid, const BeamLoop& synthetic, const Loop& real);

}  // namespace echocine::compare
