#pragma once
// The rays of a frame through its surfaces, by the tracer of the plan.

#include <optional>

#include "core/work_counts.h"
#include "frame/rolling.h"
#include "frame/workspace.h"
#include "trace/beam_rays.h"
#include "trace/trace_frame.h"

namespace echocine {

class FrameRays {
 public:
  // The scene is kept by reference.
  FrameRays(const Scene& scene, const LoopPlan& plan);

  // Whether an output needs intensities at all.
  bool receive() const { return request_.intensities; }

  // From the workspace's geometry to its polar frame. Of a group of rolling lines, what these take
  // in. Thread-safe; frames of equal number and surfaces are equal.
  WorkCounts trace(int frame, const RollingLines::Group* group, Workspace& workspace) const;

 private:
  WorkCounts through(const PlaneSlice& slice, int frame, const RollingLines::Group* group,
                     Workspace& w) const;
  WorkCounts through(const FrameGeometry& geometry, int frame, const RollingLines::Group* group,
                     Workspace& w) const;

  const Probe& probe_;
  const TraceSettings settings_;
  const PlaneRequest request_;
  std::optional<BeamRays> beams_;  // several rays per beam
};

}  // namespace echocine
