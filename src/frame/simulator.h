#pragma once
// One frame of a scene, from its instant to its pictures. Nobody else puts the stages together.

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/beam_plane.h"
#include "core/monitor.h"
#include "frame/white.h"
#include "motion/cycle/frame_time.h"
#include "motion/volumes.h"
#include "scene/scene.h"
#include "signal/picture.h"
#include "truth/truth_values.h"

namespace echocine {

class CardiacClock;
class MeshMotion;
class SignalChain;
class StageClock;
class TruthMaker;
struct FrameStages;
struct LoopPlan;
struct Making;
struct WorkCounts;
struct Workspace;

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

  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;
  ~Simulator();

  const Scene& scene() const;
  const MeshMotion& motion() const;
  const std::shared_ptr<const MeshMotion>& sharedMotion() const;
  const LoopPlan& plan() const;
  const CardiacClock& cardiacClock() const;

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
  std::shared_ptr<Workspace> workspace() const;

  // Makes a frame in a workspace: its polar frame, and where white is given its greys and picture.
  // The greys take the memory of the intensities. Returns the volumes, none where traced already.
  // Frames of equal number and phase are equal.
  Volumes make(const FrameTime& time, const Making& making, Workspace& workspace) const;

  // make() up to the intensities, and from there to the picture.
  Volumes trace(const FrameTime& time, Workspace& workspace) const;
  GreyImage& picture(double white, const FrameTime& time, Workspace& workspace, bool wanted) const;

  // What makes truth, fitted by the first call; nullptr where the scene asks for none. Errors:
  // those of TruthMaker.
  const TruthMaker* truth() const;
  // Takes surfaces and their slice from `traced` where it stands at this very phase.
  // Precondition: truth() is not nullptr.
  FrameTruth truthAt(const FrameTime& time, const Workspace* traced = nullptr) const;

  const SignalChain& chain() const;
  StageClock& clock() const;
  WorkCounts work() const;
  int tracedFrames() const;

 private:
  explicit Simulator(std::pair<Scene, std::shared_ptr<const MeshMotion>> read)
      : Simulator(std::move(read.first), std::move(read.second)) {}

  const std::unique_ptr<const FrameStages> stages_;
};

}  // namespace echocine
