#pragma once
// Traces all scan lines of one frame with several rays each, averaged over the beam.

#include "trace/beam_rays.h"
#include "trace/trace_frame.h"

namespace echocine {

// As traceFrame(), but every intensity is the average over the beam's rays, weighed at each sample;
// refraction, losses and travel times are each ray's own. A and medium are those of the ray along
// the line itself, which is traced only for them. Patterns of rays differ from frame to frame and
// line to line. Lines are worked on in parallel; the result does not depend on the number of
// threads. frame.traces are those along the lines, or empty.
// Intensities and their channels of other lines than `lines` are not defined.
// Precondition: settings.cells is none.
WorkCounts traceBeams(const FrameGeometry& geometry, const Probe& probe,
                      const TraceSettings& settings, const PlaneRequest& request,
                      const BeamRays& beams, int frame_index, LineRange lines, PolarFrame& frame);

}  // namespace echocine
