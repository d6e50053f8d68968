#pragma once
// Traces all scan lines of one frame.

#include "core/work_counts.h"
#include "geometry/frame_geometry.h"
#include "trace/line_samples.h"
#include "trace/polar_frame.h"
#include "trace/trace_settings.h"

namespace echocine {

// What is sampled of each line; decided once per loop.
struct PlaneRequest {
  std::vector<Channel> channels;  // of the intensity stack, without Channel::display
  bool signal = true;
  IntensityParts signal_parts;
};

PlaneRequest planeRequest(const Scene& scene, const EffectPlan& plan);

// Fills `frame` (its memory is reused) and returns the work. Lines are traced in parallel; each writes only
// its own column, so the result does not depend on the number of threads.
WorkCounts traceFrame(const FrameGeometry& geometry, const Probe& probe,
                     const TraceSettings& settings, const PlaneRequest& request, PolarFrame& frame);

}  // namespace echocine
