#pragma once
// Ground truth of a loop's frames: at an instant, along rolling lines, and velocities.

#include <memory>
#include <mutex>

#include "core/free_list.h"
#include "frame/rolling.h"
#include "frame/workspace.h"
#include "motion/cycle/cardiac_clock.h"
#include "trace/trace_settings.h"
#include "truth/frame_truth.h"

namespace echocine {

class TruthSource {
 public:
  // References are kept. Without a group of lines everything is at the frame's instant.
  // `as_traced`: the traced slice is that of the smooth surfaces, and of all of them. If rays bend
  // or depths follow the travel time, truth follows them through the smooth surfaces.
  TruthSource(const Scene& scene, const MeshMotion& motion, const SharedMotionField& field,
              const CardiacClock& clock, const LoopPlan& plan, const RollingLines* rolling,
              bool as_traced);

  // Fitted by the first call; nullptr if the scene requests no truth. Throws like TruthMaker.
  // Thread-safe.
  const TruthMaker* maker() const;

  // Reuses surfaces and slice of `traced` if it has exactly this phase. Precondition: maker() is
  // not nullptr.
  FrameTruth at(const FrameTime& time, const Workspace* traced) const;

 private:
  // The surfaces of an instant with its paths.
  struct PathSpace {
    SurfaceFrame surfaces;
    FrameGeometry geometry;
    SoundPaths paths;
  };
  FrameTruth ofInstant(const FrameTime& time, TruthShared shared, bool planes_only) const;
  std::shared_ptr<PathSpace> pathSpace() const;
  void addPaths(double phase, PathSpace& space, TruthShared& shared) const;

  const Scene& scene_;
  const MeshMotion& motion_;
  const SharedMotionField& field_;
  const CardiacClock& clock_;
  const RollingLines* rolling_;
  const bool as_traced_, normals_;
  std::optional<TraceSettings> bent_;  // of the paths, if echoes are not at straight path lengths
  mutable std::once_flag once_;
  mutable std::unique_ptr<const TruthMaker> maker_;
  mutable FreeList<PathSpace> spaces_;
};

}  // namespace echocine
