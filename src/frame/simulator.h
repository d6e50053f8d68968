#pragma once
// One frame of a scene, from its instant to its pictures. Nobody else puts the stages together.

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/beam_plane.h"
#include "core/stage_clock.h"
#include "core/work_counts.h"
#include "frame/persistence.h"
#include "frame/rolling.h"
#include "frame/scene_speckle.h"
#include "geometry/frame_geometry.h"
#include "geometry/plane_slice.h"
#include "geometry/side_slices.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/mesh_motion.h"
#include "motion/trabeculae.h"
#include "motion/volumes.h"
#include "plan/loop_plan.h"
#include "signal/signal_chain.h"
#include "trace/channel_plane.h"
#include "trace/thick_slice.h"
#include "trace/trace_beams.h"
#include "trace/trace_frame.h"
#include "truth/frame_truth.h"

namespace echocine {

// A frame as a caller gets it. Planes are line-major: sample k of line i stands at
// i * samples + k, line i and sample k where scene().probe has them.
struct Frame {
  FrameTime time;  // instant (s), phase of the beat, beat
  int lines = 0, samples = 0;
  Volumes volumes_ml;       // of closed structures, by name
  Intensities intensities;  // after time gain and the average over the beam, relative to I_S
  Greys greys;              // log-compressed, 0 black to 1 white
  GreyImage image;          // the scan-converted picture, without ECG and depth ticks
  std::map<Channel, std::vector<float>> channels;  // intensity channels of scene.output.channels
  std::vector<std::uint32_t> medium;               // channel medium.id, if the scene asks for it
  std::optional<FrameTruth> truth;                 // as far as scene.truth and its channels ask
};

// What one frame needs while it is made; there are as many as frames in flight.
struct Workspace {
  double phase = -1;  // that surfaces and geometry stand at
  SurfaceFrame surfaces;
  Trabeculae::Smooth smooth{};                       // surfaces while others are shown
  std::variant<PlaneSlice, FrameGeometry> geometry;  // whichever the plan's tracer needs
  PolarFrame polar;
  std::optional<SideSlices> sides{};  // of a beam that is thick across the plane
  PolarFrame side{};
  PolarFrame rolled{};  // lines of a rolling frame, as they come
  Greys greys{};
  GreyImage image{};
};

// The planes of a frame that go into its EXR, in the order of the scene's channels.
std::vector<ChannelPlane> channelPlanes(const OutputSettings& output, const Workspace& workspace);

class Simulator {
 public:
  // Reads the scene's meshes, or takes those that it holds in memory, places its probe where a view
  // asks for it, and plans the loop.
  // Throws SceneError that names the scene's key, file and face; JobError when frames between
  // keyframes are inside out.
  explicit Simulator(Scene scene);
  // Of a motion that several simulators share. Precondition: it is that of the scene.
  Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion);
  Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion, LoopPlan plan);

  const Scene& scene() const { return scene_; }
  const MeshMotion& motion() const { return *motion_; }
  const std::shared_ptr<const MeshMotion>& sharedMotion() const { return motion_; }
  const LoopPlan& plan() const { return plan_; }
  const CardiacClock& cardiacClock() const { return cardiac_clock_; }

  // The frame at an instant of the loop, from 0 s to its end; instants beyond it are refused with a
  // SceneError. The same bytes as `render` gives that instant. Thread-safe from any thread; memory
  // of `frame` and of earlier calls is used again.
  Frame frame(double time_s) const;
  void frame(double time_s, Frame& frame) const;

  // White of the loop's log compression, relative to I_S: signal.reference_intensity, or else the
  // percentile over its referenceFrames(), which the first call traces. Thread-safe.
  double referenceIntensity() const;

  // The stages one by one, for those who write files or measure. All thread-safe.

  // Borrows a workspace until the pointer dies; made on first use and used again.
  std::shared_ptr<Workspace> workspace() const;

  // motion -> geometry -> trace -> time gain and beam width: fills workspace.polar. Returns the
  // volumes. Frames of equal number and phase are equal.
  Volumes trace(const FrameTime& time, Workspace& workspace) const;

  // The two halves of trace(): up to the intensities that the lines receive, and what the signal
  // chain makes of them in place. Of rolling lines, each group of which goes through both at its
  // own instant, the first does all.
  Volumes traceLines(const FrameTime& time, Workspace& workspace) const;
  void process(const FrameTime& time, Workspace& workspace) const;

  // As trace(), with all lines at the frame's instant even where they roll: what white goes by.
  Volumes traceStill(const FrameTime& time, Workspace& workspace) const;

  // log compression -> scan conversion: workspace.polar.intensities become workspace.greys. The
  // picture is the workspace's; empty or an old one where none is wanted. `time` is what the
  // intensities were traced for; with persistence earlier frames are made too, unless they are
  // still known.
  GreyImage& picture(double reference_intensity, const FrameTime& time, Workspace& workspace,
                     bool wanted) const;

  // What makes truth, fitted by the first call; nullptr where the scene asks for none. Errors:
  // those of TruthMaker. Thread-safe.
  const TruthMaker* truth() const;
  // Takes surfaces and their slice from `traced` where it stands at this very phase.
  // Precondition: truth() is not nullptr.
  FrameTruth truthAt(const FrameTime& time, const Workspace* traced = nullptr) const;

  const SignalChain& chain() const { return chain_; }
  StageClock& clock() const { return clock_; }
  WorkCounts work() const;
  int tracedFrames() const;  // calls of traceLines()
  std::vector<KeyframeVolume> keyframeVolumes() const;

 private:
  explicit Simulator(std::pair<Scene, std::shared_ptr<const MeshMotion>> read)
      : Simulator(std::move(read.first), std::move(read.second)) {}
  Volumes volumes(const SurfaceFrame& surfaces) const;
  FrameTime timeOf(double time_s) const;
  // Of all lines, or what a group takes in.
  using Group = RollingLines::Group;
  WorkCounts traceRays(const PlaneSlice& slice, int frame, const Group* group, Workspace& w) const;
  WorkCounts traceRays(const FrameGeometry& geometry, int frame, const Group* group,
                       Workspace& w) const;
  double measureReference() const;
  // A frame's surfaces, made ready for rays.
  void stand(const FrameTime& time, Workspace& workspace) const;
  WorkCounts traceAt(const FrameTime& time, const Group* group, Workspace& workspace) const;
  void processAt(const FrameTime& time, LineRange lines, Workspace& workspace) const;
  WorkCounts traceRolling(const FrameTime& time, Workspace& workspace) const;
  Volumes traceUncounted(const FrameTime& time, Workspace& workspace, WorkCounts& work) const;
  void count(const WorkCounts& work) const;
  FrameTruth truthOf(const FrameTime& time, const TruthShared& shared, bool planes_only) const;
  Greys greysAlone(double reference_intensity, const FrameTime& time) const;

  const Scene scene_;
  const std::shared_ptr<const MeshMotion> motion_;
  const LoopPlan plan_;
  const CardiacClock cardiac_clock_;
  const SignalChain chain_;
  const TraceSettings settings_;
  const PlaneRequest request_;
  const LineRange all_lines_;
  std::optional<BeamRays> beams_;  // several rays per beam
  std::unique_ptr<const Trabeculae> trabeculae_;
  std::optional<RollingLines> rolling_;
  std::unique_ptr<const SceneSpeckle> speckle_;
  std::unique_ptr<const Persistence> persistence_;
  mutable StageClock clock_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Workspace>> free_;
  mutable WorkCounts work_;
  mutable int traced_frames_ = 0;
  mutable std::once_flag reference_once_, truth_once_;
  mutable std::unique_ptr<const TruthMaker> truth_;
  mutable double reference_intensity_ = 1;
};

}  // namespace echocine
