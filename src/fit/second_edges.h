#pragma once
// Boundaries whose edge is ambiguous, because the model has a second edge beside them.

#include <span>

#include "fit/model_plane.h"

namespace echocine::fit {

// A piece of a sheet in blood: both of its sides are visible edges.
struct SheetPoint {
  float x_m = 0, z_m = 0, nx = 0, nz = 0;
  bool end = false;  // of the sheet in the plane: its hinge or its free edge, a disc
};

// Sets BoundaryPoint::alone of the frame's blood boundaries. A profile along a normal (Eq. 4)
// contains the edges of all structures. If a sheet, or a boundary of the same sense, lies in the
// blood before a boundary (a leaflet or a papillary muscle before the wall), the profile cannot
// tell which of the two it shows. With both edges parallel at a distance a, alone is 0 for a from
// 3.5 to 7 mm and 1 below 2 or above 9 mm. Leaflets are thick and hinge on a fibrous ring: for
// sheets, alone is 0 for a from 0 to 8.5 mm and 1 below -1.5 or above 10.5 mm, and so it is for
// their ends where these are up to 3 mm aside; 1 from 4.5 mm. It is continuous in the positions.
void findSecondEdges(std::span<const SheetPoint> sheets, ModelFrame& frame);

}  // namespace echocine::fit
