#pragma once
// Runs one setting of a scene: its frames as pictures, its interfaces, and its time by stage.

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/stage.h"
#include "core/work_counts.h"
#include "frame/simulator.h"
#include "frame/workspace.h"
#include "metrics/interface_error.h"
#include "motion/cycle/cardiac_clock.h"
#include "output/exr_stack.h"
#include "output/overlay.h"
#include "plan/loop_plan.h"
#include "video/cine_writer.h"

namespace echocine {

class MeshMotion;

// Cache of motions: keyframes are read once for each kind of motion, and settings that differ in
// lines share one. They share its field and its scatterers too.
class MotionShelf {
 public:
  std::shared_ptr<const MeshMotion> motionOf(const Scene& scene);

  // A simulator of the motion. Precondition: all scenes with speckle of one shelf differ in nothing
  // that scatterers depend on but the motion.
  std::unique_ptr<const Simulator> simulatorOf(const Scene& scene, const LoopPlan& plan);

 private:
  struct Entry {
    std::shared_ptr<const MeshMotion> motion;
    std::shared_ptr<const SceneSpeckle> speckle;  // of the first simulator that has some
    std::size_t triangles = 0;
    std::uint64_t last_used = 0;
  };
  Entry& entryOf(const Scene& scene);

  std::map<std::string, Entry> shelf_;
  std::uint64_t uses_ = 0;
};

// Intensities used for a picture: those traced, or those read back after storage in the scene's EXR
// format (output.exr_compression, exr_pixel; those traced if it stores none).
enum class MadeOf { traced, stored };

// A frame of one setting, for comparison.
struct FramePicture {
  std::vector<float> grey;  // 0..1 before the grey map, -1 outside the sector
  GreyImage image;
  InterfaceMap interfaces;
};

// One batch of frames, per frame.
struct StageTimes {
  std::array<double, kStages> stage_ms{};  // summed over threads
  double wall_ms = 0;
  double exr_bytes = 0;  // of its file in the intensity stack, mean over the times; 0 without one
};

// The scene with a picture enabled: without one there is nothing to compare.
Scene showing(Scene scene);

// The plan whose intensities are the mean over all seeds of speckle, noise and clutter: without
// speckle, with noise and clutter at their mean level. Spatial variation of backscatter, a constant
// factor of each place, is left out with the speckle.
LoopPlan meanOverSeeds(LoopPlan plan);

class SettingRun {
 public:
  // The scene must have a picture. Throws SceneError if its meshes reject the setting.
  // Precondition: the shelf outlives the probe.
  SettingRun(Scene scene, MotionShelf& shelf);

  const Scene& scene() const { return scene_; }
  const LoopPlan& plan() const { return plan_; }

  // Equal for two settings that compute the same, with every "auto" resolved.
  std::string signature() const;

  // Renders the frames of meanOverSeeds() on the threads of withThreads(); writes nothing. Throws
  // Stopped at a stop.
  std::vector<FramePicture> pictures(std::span<const FrameTime> times, double reference_intensity,
                                     bool with_interfaces, MadeOf made_of = MadeOf::traced);

  // Builds what timeBatch() would build at its first call. Throws SceneError and JobError if the
  // setting cannot be rendered.
  void prepareTiming() { simulator(); }

  // The loop's white of meanOverSeeds() from these frames only: absolute if the scene has it,
  // otherwise its percentile.
  double referenceIntensity(const std::vector<FrameTime>& times);

  // Mean work of the frames that the simulator of pictures() traced since rest().
  WorkCounts workPerFrame();
  std::size_t vertices() const { return vertices_; }  // of the structures in use

  // Renders `frames` frames, cycling through the times, on the threads of withThreads(), from
  // meshes to encoded and hashed files in memory. The time of a frame is that of the batch over its
  // frames, so with several threads it is that of a loop.
  StageTimes timeBatch(std::span<const FrameTime> times, std::size_t frames,
                       double reference_intensity);

  // Releases working memory; the next frame allocates it again.
  void rest();

 private:
  const Simulator& simulator();
  const Simulator& averaged();

  Scene scene_;
  MotionShelf* shelf_;
  LoopPlan plan_;
  std::unique_ptr<const Simulator> simulator_, averaged_;  // averaged_: if it differs
  std::size_t vertices_ = 0;
};

}  // namespace echocine
