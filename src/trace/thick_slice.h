#pragma once
// Lines of a beam with finite thickness across the imaging plane: the average over a few slices.

#include "geometry/side_slices.h"
#include "trace/trace_frame.h"

namespace echocine {

// Like traceFrame() through the plane, but intensities and coherent echoes are Eq. 1 of
// scene/elevation_slices.h over all slices. Media and exponents are those of the plane itself.
// side: buffer for the other slices. For a uniform field the weights sum to 1 within rounding.
WorkCounts traceThick(const PlaneSlice& plane, const SideSlices& sides, const Probe& probe,
                      const TraceSettings& settings, const PlaneRequest& request, PolarFrame& frame,
                      PolarFrame& side, const NeededSamples* needed = nullptr);

}  // namespace echocine
