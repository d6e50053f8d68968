#pragma once
// One frame of a scene, from its instant to its pictures. Nobody else puts the stages together.

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
#include "motion/mesh_motion.h"
#include "motion/trabeculae.h"
#include "motion/volumes.h"
#include "plan/loop_plan.h"
#include "signal/signal_chain.h"
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

// Which stages of a frame are carried out, and how.
struct Making {
  bool traced = false;   // the workspace's intensities are the frame's already: the later stages
  bool still = false;    // all lines at the frame's instant, even where they roll
  bool counted = true;   // as work of the loop
  bool persists = true;  // greys of earlier frames are mixed in, where the scene asks for it
  bool picture = false;  // scan conversion too
  std::optional<double> white{};  // of the log compression; without it intensities are the last
  // Sees the intensities that the lines receive, before the signal chain; those of rolling lines,
  // whose groups go through it one by one, after it.
  std::function<void(Intensities&)> received{};
};

class Simulator {
 public:
  // Reads the scene's meshes, or takes those that it holds in memory, places its probe where a view
  // asks for it, and plans the loop.
  // Throws SceneError that names the scene's key, file and face; JobError when frames between
  // keyframes are inside out.
  explicit Simulator(Scene scene);
  // With a motion that several simulators share. Precondition: it was made from this scene.
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
  // percentile over its referenceFrames(), which the first call traces. Thread-safe. The second
  // form works on the threads of the enclosing withThreads(), and gives nothing when the monitor
  // stops it; `keep` gets the frames, unless white is known already.
  double referenceIntensity() const;
  std::optional<double> referenceIntensity(const Monitor& monitor, const KeepTraced& keep) const;

  // The stages, for those who write files or measure. All thread-safe.

  // Borrows a workspace until the pointer dies; made on first use and used again.
  std::shared_ptr<Workspace> workspace() const { return workspaces_.borrow(); }

  // Makes a frame in a workspace: its polar frame, and where white is given its greys and picture.
  // The greys take the memory of the intensities. Returns the volumes, none where traced already.
  // Frames of equal number and phase are equal.
  Volumes make(const FrameTime& time, const Making& making, Workspace& workspace) const;

  // make() up to the intensities, and from there to the picture.
  Volumes trace(const FrameTime& time, Workspace& workspace) const {
    return make(time, {}, workspace);
  }
  GreyImage& picture(double white, const FrameTime& time, Workspace& workspace, bool wanted) const {
    make(time, {.traced = true, .picture = wanted, .white = white}, workspace);
    return workspace.image;
  }

  // What makes truth, fitted by the first call; nullptr where the scene asks for none. Errors:
  // those of TruthMaker.
  const TruthMaker* truth() const { return truth_.maker(); }
  // Takes surfaces and their slice from `traced` where it stands at this very phase.
  // Precondition: truth() is not nullptr.
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
  // Null where the plan leaves the effect out.
  std::unique_ptr<const Trabeculae> trabeculae_;
  std::unique_ptr<const SceneSpeckle> speckle_;
  std::unique_ptr<const RollingLines> rolling_;
  std::unique_ptr<const Persistence> persistence_;
  const TruthSource truth_;
  const WorkspacePool workspaces_;
  mutable StageClock clock_;
  mutable WorkTally tally_;
  mutable std::mutex white_mutex_;
  mutable std::optional<double> white_;  // once it was measured
};

}  // namespace echocine
