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
  // References are kept. Without a group of lines everything is at the frame's instant.
  // `as_traced`: the traced slice is that of the smooth surfaces, and of all of them.
  TruthSource(const Scene& scene, const MeshMotion& motion, const CardiacClock& clock,
              const RollingLines* rolling, bool as_traced)
      : scene_(scene), motion_(motion), clock_(clock), rolling_(rolling), as_traced_(as_traced) {}

  // Fitted by the first call; nullptr if the scene requests no truth. Throws like TruthMaker.
  // Thread-safe.
  const TruthMaker* maker() const;

  // Reuses surfaces and slice of `traced` if it has exactly this phase. Precondition: maker() is
  // not nullptr.
  FrameTruth at(const FrameTime& time, const Workspace* traced) const;

 private:
  FrameTruth ofInstant(const FrameTime& time, const TruthShared& shared, bool planes_only) const;

  const Scene& scene_;
  const MeshMotion& motion_;
  const CardiacClock& clock_;
  const RollingLines* rolling_;
  const bool as_traced_;
  mutable std::once_flag once_;
  mutable std::unique_ptr<const TruthMaker> maker_;
};

}  // namespace echocine
