#pragma once
// Ground truth of a loop's frames: at an instant, along rolling lines, and velocities.

#include <memory>
#include <mutex>

#include "frame/rolling.h"
#include "frame/workspace.h"
#include "motion/cycle/cardiac_clock.h"
#include "trace/trace_settings.h"
#include "truth/frame_truth.h"

namespace echocine {

class TruthSource {
 public:
  // References are kept. Without a group of lines all are of the frame's instant. `as_traced`: the
  // slice that is traced is that of the smooth surfaces, and of all of them. Where rays bend or
  // depths follow the travel time, truth follows them through the smooth surfaces.
  TruthSource(const Scene& scene, const MeshMotion& motion, const CardiacClock& clock,
              const LoopPlan& plan, const RollingLines* rolling, bool as_traced);

  // Fitted by the first call; nullptr where the scene asks for no truth. Errors: those of
  // TruthMaker. Thread-safe.
  const TruthMaker* maker() const;

  // Takes surfaces and their slice from `traced` where it stands at this very phase.
  // Precondition: maker() is not nullptr.
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
  const CardiacClock& clock_;
  const RollingLines* rolling_;
  const bool as_traced_, normals_;
  std::optional<TraceSettings>
      bent_;  // of the paths, where echoes stand at no straight path lengths
  mutable std::once_flag once_;
  mutable std::unique_ptr<const TruthMaker> maker_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<PathSpace>> free_;
};

}  // namespace echocine
