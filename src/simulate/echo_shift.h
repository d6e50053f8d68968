#pragma once
// How far refraction moves the echoes of a scene: the honest ground for leaving it out.

#include <vector>

#include "geometry/frame_geometry.h"
#include "trace/trace_settings.h"

namespace echocine {

// One echo's distance from the straight line it would lie on without refraction.
struct EchoShift {
  double metres = 0;
  double spacings = 0;  // in distances between neighbouring lines at its depth
};

// Traces every line of one frame with refraction and appends the shifts of all interfaces that are
// seen.
void measureEchoShifts(const FrameGeometry& geometry, const Probe& probe, TraceSettings settings,
                       std::vector<EchoShift>& shifts);

}  // namespace echocine
