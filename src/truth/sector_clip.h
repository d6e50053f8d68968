#pragma once
// Contours within the sector: closed along its edges where they are cut.

#include <vector>

#include "core/vec3.h"
#include "scene/scan_geometry.h"

namespace echocine {

// The part of a closed polygon of the imaging plane within a convex outline (Sutherland and
// Hodgman, Comm. ACM 17(1), 32-42, 1974); may be empty. Parts connected only outside are joined
// along the outline.
std::vector<Vec3d> clipped(std::vector<Vec3d> polygon, const std::vector<Vec3d>& outline);

}  // namespace echocine
