#pragma once
// Traces all scan lines of one frame.

#include "core/work_counts.h"
#include "geometry/frame_geometry.h"
#include "geometry/plane_slice.h"
#include "trace/line_samples.h"
#include "trace/polar_frame.h"
#include "trace/trace_settings.h"

namespace echocine {

// The sampled planes of each line; decided once per loop.
struct PlaneRequest {
  std::vector<Channel> channels;  // of the intensity stack, without Channel::display
  double spread_undone_at_m = 0;  // of the channels: 0 unless the scene turns the spread off
  double echo_samples = 1;        // of the channels: IntensityTerms
  bool intensities = true;        // for the signal chain
  IntensityTerms intensity_terms;
};

// For a frame that uses only some lines: the lines of the channels, and for each line the number of
// intensity samples, from the first.
struct NeededSamples {
  LineRange lines;
  std::vector<int> intensities;
};

PlaneRequest planeRequest(const Scene& scene, const EffectPlan& plan);

Sampling samplingOf(const Probe& probe, const TraceSettings& settings);

// The parts of an intensity channel.
IntensityTerms partsOf(Channel channel, bool attenuation, double spread_undone_at_m);

// Sets the frame's size and allocates the requested planes.
void reservePlanes(const Probe& probe, const PlaneRequest& request, PolarFrame& frame);

// Traces all lines through the media, without sampling them.
WorkCounts walkLines(const FrameGeometry& geometry, const Probe& probe,
                     const TraceSettings& settings, std::vector<LineTrace>& traces);

// Precondition of both: settings.cells is none, or the tracer's own kind (links for the hierarchy,
// contours for the slice) with at least two lines. Fills `frame` (reusing its memory) and returns
// the work. Lines are sampled in parallel; each writes only its own column, so the result does not
// depend on the number of threads. needed: the planes to sample, with the same values; null: all.
WorkCounts traceFrame(const FrameGeometry& geometry, const Probe& probe,
                      const TraceSettings& settings, const PlaneRequest& request, PolarFrame& frame,
                      const NeededSamples* needed = nullptr);

// The same through the plane slice. Precondition: settings.refraction is off.
WorkCounts traceFrame(const PlaneSlice& slice, const Probe& probe, const TraceSettings& settings,
                      const PlaneRequest& request, PolarFrame& frame,
                      const NeededSamples* needed = nullptr);

}  // namespace echocine
