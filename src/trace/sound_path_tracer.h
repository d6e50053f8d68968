#pragma once
// The sound paths of a frame, by the walk that makes its picture.

#include <vector>

#include "geometry/frame_geometry.h"
#include "geometry/sound_paths.h"
#include "trace/line_trace.h"
#include "trace/trace_settings.h"

namespace echocine {

// Rays bend, and depths follow the travel time, where the plan says so. Losses and echoes are left
// out. A total reflection ends no path, so that truth goes on in its shadow.
TraceSettings soundPathSettings(const Scene& scene, const EffectPlan& plan);

// Fills the paths of `into`, whose probe says which lines they run along. Geometry: of all
// surfaces.
void traceSoundPaths(const FrameGeometry& geometry, const TraceSettings& settings,
                     SoundPaths& into);

}  // namespace echocine
