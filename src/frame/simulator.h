#pragma once
// One frame of a scene, from its instant to its pictures: the only place that combines the stages.

#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "core/beam_plane.h"
#include "core/monitor.h"
#include "frame/white.h"
#include "motion/cycle/frame_time.h"
#include "motion/surfaces/volumes.h"
#include "scene/scene.h"
#include "signal/picture.h"
#include "truth/truth_values.h"

namespace echocine {

class CardiacClock;
class MeshMotion;
class MotionField;
class SceneSpeckle;
class SignalChain;
class StageClock;
class TruthMaker;
struct FrameStages;
struct LoopPlan;
struct Making;
struct WorkCounts;
struct Workspace;

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

class Simulator {
 public:
  // Reads the scene's meshes or uses those in memory, places its probe for a view, and plans the
  // loop. Throws SceneError that names the scene's key, file and face; JobError if a surface is
  // inverted between keyframes.
  explicit Simulator(Scene scene);
  // Shares the motion with other simulators. Precondition: it was made from this scene. `field`: of
  // the tissue, from a scene of the same structures, motion_field_cells and trabeculae; null: it is
  // fitted here.
  Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion,
            std::shared_ptr<const MotionField> field = nullptr);
  // `source`: speckle of another simulator of this motion, whose field is shared, and whose
  // scatterers too unless the seeds of speckle differ. Otherwise its precondition is that of
  // SceneSpeckle. `field`: as above, if there is no source.
  Simulator(Scene scene, std::shared_ptr<const MeshMotion> motion, LoopPlan plan,
            const SceneSpeckle* source = nullptr,
            std::shared_ptr<const MotionField> field = nullptr);

  // Shares motion, plan and speckle of another simulator likewise. Precondition: their scenes
  // differ at most in lines, samples, seeds and what neither plan nor scatterers depend on.
  Simulator(Scene scene, const Simulator& source);

  Simulator(const Simulator&) = delete;
  Simulator& operator=(const Simulator&) = delete;
  ~Simulator();

  const Scene& scene() const;
  const MeshMotion& motion() const;
  const std::shared_ptr<const MeshMotion>& sharedMotion() const;
  const std::shared_ptr<const SceneSpeckle>& sharedSpeckle() const;  // null without speckle
  const LoopPlan& plan() const;
  const CardiacClock& cardiacClock() const;

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
  std::shared_ptr<Workspace> workspace() const;

  // Computes a frame in a workspace: its polar frame and, if white is given, its grey levels and
  // picture. The grey levels reuse the memory of the intensities. Returns the volumes, empty if
  // already traced. Frames of equal number and phase are equal.
  Volumes make(const FrameTime& time, const Making& making, Workspace& workspace) const;

  // make() up to the intensities, and from the intensities to the picture.
  Volumes trace(const FrameTime& time, Workspace& workspace) const;
  GreyImage& picture(double white, const FrameTime& time, Workspace& workspace, bool wanted) const;

  // The maker of truth, fitted by the first call; nullptr if the scene requests no truth. Throws
  // like TruthMaker.
  const TruthMaker* truth() const;
  // Reuses surfaces and slice of `traced` if it has exactly this phase. Precondition: truth() is
  // not nullptr.
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

// Passes on the warnings of the scene and of its plan.
void passWarnings(const Simulator& simulator, const Monitor& monitor);

}  // namespace echocine
