#pragma once
// The rays of a frame through its surfaces, by the planned tracer.

#include <optional>

#include "core/work_counts.h"
#include "frame/rolling.h"
#include "frame/workspace.h"
#include "motion/surfaces/valve_parts.h"
#include "trace/beam_rays.h"
#include "trace/trace_frame.h"

namespace echocine {

class FrameRays {
 public:
  // The scene and `valves` are kept by reference. Bodies replace leaflets.
  FrameRays(const Scene& scene, const LoopPlan& plan, const ValveParts& valves);

  // Does an output need intensities?
  bool receive() const { return request_.intensities; }

  // Traces the workspace's geometry into its polar frame; for a group of rolling lines only what
  // the group needs. Thread-safe; frames of equal number and surfaces are equal.
  WorkCounts trace(int frame, const RollingLines::Group* group, Workspace& workspace) const;

 private:
  WorkCounts through(const PlaneSlice& slice, int frame, const RollingLines::Group* group,
                     Workspace& w) const;
  WorkCounts through(const FrameGeometry& geometry, int frame, const RollingLines::Group* group,
                     Workspace& w) const;
  void addChordae(Workspace& w) const;
  void addRings(Workspace& w) const;

  const Probe& probe_;
  const TraceSettings settings_;
  const PlaneRequest request_;
  std::optional<BeamRays> beams_;  // several rays per beam
  const ValveParts& valves_;
  double chordae_m_;         // their diameter
  double ring_backscatter_;  // relative to that of the leaflets
};

}  // namespace echocine
