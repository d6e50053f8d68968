#pragma once
// Lines of a beam that is thick across the imaging plane: the average of a few slices.

#include "geometry/side_slices.h"
#include "trace/trace_frame.h"

namespace echocine {

// As traceFrame() through the plane, whose intensities and coherent echoes become Eq. 1 of
// scene/elevation_slices.h over all slices. Media and exponents stay those of the plane itself.
// side: room for the other slices, used again. Weights of an even field add up to it but for
// rounding.
WorkCounts traceThick(const PlaneSlice& plane, const SideSlices& sides, const Probe& probe,
                      const TraceSettings& settings, const PlaneRequest& request, PolarFrame& frame,
                      PolarFrame& side, const NeededSamples* needed = nullptr);

}  // namespace echocine
