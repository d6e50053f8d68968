#pragma once
// Traces all scan lines of one frame with several rays each, averaged over the beam.

#include "trace/beam_rays.h"
#include "trace/trace_frame.h"

namespace echocine {

// Like traceFrame(), but every intensity is the average over the beam's rays, weighted at each
// sample; refraction, losses and travel times are those of each ray. A and medium are those of the
// ray along the line itself, which is traced only for them. Patterns of rays differ between frames
// and lines. Lines are traced in parallel; the result does not depend on the number of threads.
// frame.traces are those along the lines, or empty. Intensities and their channels outside `lines`
// are undefined. Precondition: settings.cells is none.
WorkCounts traceBeams(const FrameGeometry& geometry, const Probe& probe,
                      const TraceSettings& settings, const PlaneRequest& request,
                      const BeamRays& beams, int frame_index, LineRange lines, PolarFrame& frame);

}  // namespace echocine
