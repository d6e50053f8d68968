#pragma once
// One setting of a scene at work: its frames as pictures, its interfaces, and its time by stage.

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/stage.h"
#include "core/work_counts.h"
#include "frame/simulator.h"
#include "frame/workspace.h"
#include "metrics/interface_error.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/mesh_motion.h"
#include "output/exr_stack.h"
#include "output/overlay.h"
#include "plan/loop_plan.h"
#include "video/cine_writer.h"

namespace echocine {

// Keyframes are read once for each way of moving them: settings that differ in lines share one.
class MotionShelf {
 public:
  std::shared_ptr<const MeshMotion> motionOf(const Scene& scene);

 private:
  struct Entry {
    std::shared_ptr<const MeshMotion> motion;
    std::size_t triangles = 0;
    std::uint64_t last_used = 0;
  };
  std::map<std::string, Entry> shelf_;
  std::uint64_t uses_ = 0;
};

// Which intensities a picture is made of: those that were traced, or what is read back of them once
// they are stored the way the scene stores its channels (output.exr_compression, exr_pixel; those
// that were traced where it stores none).
enum class MadeOf { traced, stored };

// A frame of one setting as it is compared.
struct FramePicture {
  std::vector<float> grey;  // 0..1 before the grey map, -1 outside the sector
  GreyImage image;
  InterfaceMap interfaces;
  std::size_t exr_bytes = 0;  // of its file in the intensity stack; of stored intensities alone
};

// Milliseconds of one batch of frames, per frame.
struct StageTimes {
  std::array<double, kStages> stage_ms{};  // summed over threads
  double wall_ms = 0;
};

// The scene, made to show a picture if it asks for none: without one there is nothing to compare.
Scene showing(Scene scene);

class SettingRun {
 public:
  // The scene must make a picture. Throws SceneError when its meshes refuse the setting.
  // Precondition: the shelf outlives the probe.
  SettingRun(Scene scene, MotionShelf& shelf);

  const Scene& scene() const { return scene_; }
  const LoopPlan& plan() const { return plan_; }

  // Equal for two settings that compute the same: what "auto" became takes its place.
  std::string signature() const;

  // Traces the frame; nothing is written.
  FramePicture picture(const FrameTime& time, double reference_intensity, bool with_interfaces,
                       MadeOf made_of = MadeOf::traced);

  // The loop's white from these frames alone: absolute if the scene has it, else its percentile.
  double referenceIntensity(const std::vector<FrameTime>& times);

  // Work of one frame, a mean over those traced so far.
  WorkCounts workPerFrame() const;
  std::size_t vertices() const { return vertices_; }  // of the structures that stay

  // Makes `frames` frames of the times, round and round, on the threads of withThreads(), from
  // meshes to encoded and hashed files in memory. The time of a frame is the batch's over its
  // frames, so on several threads it is that of a loop.
  StageTimes timeBatch(const std::vector<FrameTime>& times, std::size_t frames,
                       double reference_intensity);

  // Gives back what frames need while they are made; the next frame builds it anew.
  void rest();

 private:
  const Simulator& simulator();
  InterfaceMap interfacesOf(Workspace& workspace) const;

  Scene scene_;
  MotionShelf* shelf_;
  LoopPlan plan_;
  std::unique_ptr<const Simulator> simulator_;
  WorkCounts work_;
  int worked_frames_ = 0;
  std::size_t vertices_ = 0;
};

}  // namespace echocine
