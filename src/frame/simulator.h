#pragma once
// One frame of a scene, from its instant to its pictures: the only place that combines the stages.

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/beam_plane.h"
#include "core/stage_clock.h"
#include "core/work_counts.h"
#include "frame/frame_rays.h"
#include "frame/persistence.h"
#include "frame/rolling.h"
#include "frame/scene_speckle.h"
#include "frame/truth_source.h"
#include "frame/white.h"
#include "frame/work_tally.h"
#include "frame/workspace.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/trabeculae.h"
#include "motion/surfaces/volumes.h"
#include "plan/loop_plan.h"
#include "signal/signal_chain.h"
#include "truth/frame_truth.h"

namespace echocine {

// A frame for callers. Planes are line-major: sample k of line i has the index i * samples + k;
// scene().probe has their positions.
struct Frame {
  FrameTime time;  // instant (s), phase of the beat, beat
  int lines = 0, samples = 0;
  Volumes volumes_ml;       // of closed structures, by name
  Intensities intensities;  // after time gain and the average over the beam, relative to I_S
  Greys greys;              // log-compressed, 0 black to 1 white
  GreyImage image;          // the scan-converted picture, without ECG and depth ticks
  std::map<Channel, std::vector<float>> channels;  // intensity channels of scene.output.channels
  std::vector<std::uint32_t> medium;               // channel medium.id, if requested
  std::optional<FrameTruth> truth;                 // as requested by scene.truth and the channels
};

// The stages of a frame to run, and their options.
struct Making {
  bool traced = false;   // the workspace already has the frame's intensities: later stages only
  bool still = false;    // all lines at the frame's instant, even if they roll
  bool counted = true;   // counts as work of the loop
  bool persists = true;  // mixes in earlier frames, if the scene has persistence
  bool picture = false;  // runs scan conversion too
  std::optional<double>
      white{};  // of the log compression; without it the frame ends with intensities
  // Receives the intensities of the lines before the signal chain; for rolling lines, whose groups
  // pass the chain separately, after it.
  std::function<void(Intensities&)> received{};
};

class Simulator {
 public:
  // Reads the scene's meshes or uses those in memory, places its probe for a view, and plans the
  // loop. Throws SceneError that names the scene's key, file and face; JobError if frames between
  // keyframes are inside out.
  explicit Simulator(Scene scene);
  // Shares the motion with other simulators. Precondition: it was made from this scene.
  Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion);
  Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion, LoopPlan plan);

  const Scene& scene() const { return scene_; }
  const MeshMotion& motion() const { return *motion_; }
  const std::shared_ptr<const MeshMotion>& sharedMotion() const { return motion_; }
  const LoopPlan& plan() const { return plan_; }
  const CardiacClock& cardiacClock() const { return cardiac_clock_; }

  // The frame at an instant of the loop, from 0 s to its end; other instants are rejected with a
  // SceneError. Same bytes as `render` at that instant. Thread-safe; reuses the memory of `frame`
  // and of earlier calls.
  Frame frame(double time_s) const;
  void frame(double time_s, Frame& frame) const;

  // White of the loop's log compression, relative to I_S: signal.reference_intensity, otherwise the
  // percentile over its referenceFrames(), which the first call traces. Thread-safe. The second
  // form uses the threads of the enclosing withThreads() and returns none when the monitor stops
  // it; `keep` receives the frames, unless white is already known.
  double referenceIntensity() const;
  std::optional<double> referenceIntensity(const Monitor& monitor, const KeepTraced& keep) const;

  // The stages, for code that writes files or measures. All are thread-safe.

  // Borrows a workspace for the lifetime of the pointer. Workspaces are created on demand and
  // reused.
  std::shared_ptr<Workspace> workspace() const { return workspaces_.borrow(); }

  // Computes a frame in a workspace: its polar frame and, if white is given, its grey levels and
  // picture. The grey levels reuse the memory of the intensities. Returns the volumes, empty if
  // already traced. Frames of equal number and phase are equal.
  Volumes make(const FrameTime& time, const Making& making, Workspace& workspace) const;

  // make() up to the intensities, and from the intensities to the picture.
  Volumes trace(const FrameTime& time, Workspace& workspace) const {
    return make(time, {}, workspace);
  }
  GreyImage& picture(double white, const FrameTime& time, Workspace& workspace, bool wanted) const {
    make(time, {.traced = true, .picture = wanted, .white = white}, workspace);
    return workspace.image;
  }

  // The maker of truth, fitted by the first call; nullptr if the scene requests no truth. Throws
  // like TruthMaker.
  const TruthMaker* truth() const { return truth_.maker(); }
  // Reuses surfaces and slice of `traced` if it has exactly this phase. Precondition: truth() is
  // not nullptr.
  FrameTruth truthAt(const FrameTime& time, const Workspace* traced = nullptr) const {
    return truth_.at(time, traced);
  }

  const SignalChain& chain() const { return chain_; }
  StageClock& clock() const { return clock_; }
  WorkCounts work() const { return tally_.work(); }
  int tracedFrames() const { return tally_.frames(); }

 private:
  explicit Simulator(std::pair<Scene, std::shared_ptr<const MeshMotion>> read)
      : Simulator(std::move(read.first), std::move(read.second)) {}
  void stand(const FrameTime& time, Workspace& workspace) const;
  void process(const FrameTime& time, LineRange lines, Workspace& workspace) const;
  Greys withoutPersistence(double white, const FrameTime& time) const;

  const Scene scene_;
  const std::shared_ptr<const MeshMotion> motion_;
  const LoopPlan plan_;
  const CardiacClock cardiac_clock_;
  const SignalChain chain_;
  const FrameRays rays_;
  const SharedMotionField field_;  // of speckle and of truth
  // Null if the plan disables the effect.
  std::unique_ptr<const Trabeculae> trabeculae_;
  std::unique_ptr<const SceneSpeckle> speckle_;
  std::unique_ptr<const RollingLines> rolling_;
  std::unique_ptr<const Persistence> persistence_;
  const TruthSource truth_;
  const WorkspacePool workspaces_;
  mutable StageClock clock_;
  mutable WorkTally tally_;
  mutable std::mutex white_mutex_;
  mutable std::optional<double> white_;  // once measured
};

}  // namespace echocine
