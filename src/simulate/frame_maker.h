#pragma once
// One frame from its phase to its pictures, with the memory that a frame needs while it is made.

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/stage_clock.h"
#include "core/work_counts.h"
#include "geometry/frame_geometry.h"
#include "geometry/plane_slice.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/mesh_motion.h"
#include "motion/volumes.h"
#include "output/frame_record.h"
#include "scene/loop_plan.h"
#include "signal/signal_chain.h"
#include "trace/trace_beams.h"
#include "trace/trace_frame.h"

namespace echocine {

// Surfaces and hierarchy of one frame in the making; there are as many as frames in flight.
struct Workspace {
  SurfaceFrame surfaces;
  std::variant<PlaneSlice, FrameGeometry> geometry;  // whichever the plan's tracer needs
  PolarFrame polar;
  GreyImage image{};
};

// The planes of a frame that go into its EXR, in the order of the scene's channels.
std::vector<ChannelPlane> channelPlanes(const OutputSettings& output, const PolarFrame& polar);

class FrameMaker {
 public:
  FrameMaker(const Scene& scene, const LoopPlan& plan, const MeshMotion& motion);

  // Borrows a workspace until the pointer dies; made on first use and used again.
  std::shared_ptr<Workspace> workspace();

  // motion -> geometry -> trace -> time gain and beam width: fills workspace.polar. Returns the
  // volumes. Frames of equal number and phase are equal.
  Volumes trace(const FrameTime& time, Workspace& workspace);

  // The two halves of trace(): up to the intensities that the lines receive, and what the signal
  // chain makes of them in workspace.polar.signal.
  Volumes traceLines(const FrameTime& time, Workspace& workspace);
  void process(const FrameTime& time, Workspace& workspace);

  // log compression -> scan conversion: workspace.polar.signal becomes grey. The picture is the
  // workspace's; empty or an old one where none is wanted.
  GreyImage& picture(double reference_intensity, Workspace& workspace, bool wanted);

  const SignalChain& chain() const { return chain_; }
  StageClock& clock() { return clock_; }
  const StageClock& clock() const { return clock_; }
  WorkCounts work() const;
  int tracedFrames() const;  // calls of traceLines()
  std::vector<KeyframeVolume> keyframeVolumes() const;

 private:
  Volumes volumes(const SurfaceFrame& surfaces) const;
  WorkCounts traceRays(const PlaneSlice& slice, int frame, PolarFrame& polar) const;
  WorkCounts traceRays(const FrameGeometry& geometry, int frame, PolarFrame& polar) const;

  const Scene& scene_;
  const LoopPlan& plan_;
  const MeshMotion& motion_;
  SignalChain chain_;
  TraceSettings settings_;
  PlaneRequest request_;
  std::optional<BeamRays> beams_;  // several rays per beam
  StageClock clock_;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<Workspace>> free_;
  WorkCounts work_;
  int traced_frames_ = 0;
};

}  // namespace echocine
