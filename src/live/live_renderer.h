#pragma once
// Pictures of a scene whose probe moves. Meshes are read once.

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "frame/simulator.h"
#include "motion/surfaces/keyframe_set.h"
#include "motion/surfaces/surface_frame.h"
#include "motion/surfaces/volumes.h"
#include "output/overlay.h"
#include "plan/loop_plan.h"
#include "scene/scene.h"

namespace echocine::live {

// Rendering effort. `moving`: for a probe in the hand, with fewer lines, one plane slice, straight
// rays and without speckle, persistence and rolling. `still`: the picture that `render` writes.
enum class Effort { moving, still };

struct LivePicture {
  GreyImage image;  // with ECG and depth ticks, as in render's PNG
  FrameTime time;
  int frames = 0;                     // of the loop
  double milliseconds = 0;            // spent on it
  double prepared_ms = 0;             // of these on what does not depend on the frame
  Volumes volumes_ml{};               // of a still picture
  std::vector<std::string> warnings;  // of a still picture: what its pose and settings leave unseen
};

// Not thread-safe: one renderer serves one job at a time. All functions run inside withThreads()
// and may be cancelled at checkpoints (core/stop.h) without harm.
class LiveRenderer {
 public:
  // Reads the scene's meshes. Throws SceneError.
  explicit LiveRenderer(const Scene& scene);
  ~LiveRenderer();

  // Frame `frame` of the scene's loop. `name` identifies the scene: with the name of the last still
  // picture its preparation is reused, and kept frames are returned at once. Throws SceneError,
  // also if the frame is not in the loop, and JobError.
  LivePicture still(const Scene& scene, const std::string& name, int frame);

  // The same frame with less effort. `settings` identifies all of the scene but the probe's pose:
  // with those of the last moving picture its signal chain is reused. White of the log compression
  // is that of the scene, or else of the last still picture.
  LivePicture moving(const Scene& scene, const std::string& settings, int frame);

  // CPU time of a frame, without its preparation: the least of the three frames after
  // `frame`.
  double cost_ms(const Scene& scene, int frame) const;

  // The motion in the frame of the session's first pose.
  const MeshMotion& motion() const { return *motion_; }

  // The plan and the simulator of the last still picture, prepared if necessary.
  const Simulator& prepared(const Scene& scene, const std::string& name);

 private:
  struct Still;
  Still& stillOf(const Scene& scene, const std::string& name);
  KeyframeSet meshesAt(double phase);

  KeyframeSet keyframes_;
  std::shared_ptr<const MeshMotion> motion_;  // of the first pose, for meshes of an instant
  Pose motion_pose_;
  MotionSettings motion_settings_;
  std::unique_ptr<Still> still_;
  std::optional<double> white_;  // last one that was measured
  SurfaceFrame surfaces_;        // scratch memory of meshesAt()
  // These belong to the last moving picture.
  std::string settings_;
  std::shared_ptr<const SignalChain> chain_;
  std::optional<Overlay> overlay_;
};

// The quality of a picture, in words.
std::string qualityWords(const Scene& scene, Effort effort);

// The scene without files and truth, which neither effort needs.
Scene pictureOnly(Scene scene);

}  // namespace echocine::live
