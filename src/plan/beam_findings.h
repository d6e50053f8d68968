#pragma once
// The scene's requirements for the beam: its width across the lines and across the imaging plane.

#include "plan/finding.h"
#include "scene/scene.h"

namespace echocine {

// Is each beam traced by several rays?
bool severalRays(const Scene& scene);

// Is it traced along several slices across the plane? Several rays sample that direction
// themselves.
bool severalSlices(const Scene& scene);

// Are several rays spread across the lines?
bool lateralRays(const Scene& scene);

Finding findBeamWidth(const Scene& scene);
Finding findElevation(const Scene& scene);

}  // namespace echocine
