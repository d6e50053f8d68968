#pragma once
// Ground truth of a loop's frames: at an instant, along rolling lines, and velocities.

#include <memory>
#include <mutex>

#include "frame/rolling.h"
#include "frame/workspace.h"
#include "motion/cycle/cardiac_clock.h"
#include "truth/frame_truth.h"

namespace echocine {

class TruthSource {
 public:
  // References are kept. Without a group of lines all are of the frame's instant. `as_traced`: the
  // slice that is traced is that of the smooth surfaces, and of all of them.
  TruthSource(const Scene& scene, const MeshMotion& motion, const SharedMotionField& field,
              const CardiacClock& clock, const RollingLines* rolling, bool as_traced)
      : scene_(scene),
        motion_(motion),
        field_(field),
        clock_(clock),
        rolling_(rolling),
        as_traced_(as_traced) {}

  // Fitted by the first call; nullptr where the scene asks for no truth. Errors: those of
  // TruthMaker. Thread-safe.
  const TruthMaker* maker() const;

  // Takes surfaces and their slice from `traced` where it stands at this very phase.
  // Precondition: maker() is not nullptr.
  FrameTruth at(const FrameTime& time, const Workspace* traced) const;

 private:
  FrameTruth ofInstant(const FrameTime& time, const TruthShared& shared, bool planes_only) const;

  const Scene& scene_;
  const MeshMotion& motion_;
  const SharedMotionField& field_;
  const CardiacClock& clock_;
  const RollingLines* rolling_;
  const bool as_traced_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const TruthMaker> maker_;
};

}  // namespace echocine
