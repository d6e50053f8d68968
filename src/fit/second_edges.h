#pragma once
// Boundaries whose edge is ambiguous: the model has a second edge beside them, or their surface is
// oblique to the plane.

#include <span>

#include "fit/model_plane.h"

namespace echocine::fit {

// A piece of a sheet in blood: both of its sides are visible edges.
struct SheetPoint {
  float x_m = 0, z_m = 0, nx = 0, nz = 0;
};

// Distance in the plane that an oblique surface moves within the thickness of the slice, at most
// kMostOblique_m:
// (20)  m = sqrt(3) sigma |n_y| / sqrt(n_x^2 + n_z^2).
// normal: of the surface, y across the plane; of any length. deviation_m: sigma, the SD of the
// beam's profile across the plane; sqrt(3) sigma is the outer one of three slices
// (elevation_slices.h). Limit: the surface is straight over the slice.
float obliqueShift(const Vec3d& normal, double deviation_m);
inline constexpr double kMostOblique_m = 3e-3;  // our choice: walls curve

// Share of an edge that the loop shows at one place: 1 for m up to 1 mm, 0 from 2 mm, linear
// between.
float distinctShare(float oblique_m);

// Multiplies BoundaryPoint::distinct of the frame's blood boundaries. A profile along a normal (Eq.
// 4) contains the edges of all structures. If a sheet, or a boundary of the same sense, lies in the
// blood before a boundary (a leaflet or a papillary muscle before the wall), the profile cannot
// tell which of the two it shows. With both edges parallel at a distance a, the factor is 0 for a
// from 3.5 to 7 mm and 1 below 2 or above 9 mm. It is continuous in the positions.
void findSecondEdges(std::span<const SheetPoint> sheets, ModelFrame& frame);

}  // namespace echocine::fit
