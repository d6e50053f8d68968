#pragma once
// Contours as the sector shows them: closed where its edges cut them.

#include <vector>

#include "core/vec3.h"
#include "scene/probe.h"

namespace echocine {

// The scan area's outline from outside, clockwise as seen in the picture: convex for sectors up to
// 180 degrees, the arc of the deepest samples as a fine polygon. The face's own arc is left out.
std::vector<Vec3d> sectorOutline(const Probe& probe);

// The part of a closed polygon of the imaging plane within a convex outline (Sutherland and
// Hodgman, Comm. ACM 17(1), 32-42, 1974); empty when nothing is. Parts that hang together only
// outside are joined along the outline.
std::vector<Vec3d> clipped(std::vector<Vec3d> polygon, const std::vector<Vec3d>& outline);

}  // namespace echocine
