#pragma once
// Tilts of a model's plane out of the real imaging plane; shifts and rotations within the plane are
// the pose's.

#include <functional>

#include "core/monitor.h"
#include "fit/model_discrepancy.h"

namespace echocine::fit {

// Deviation of the probe from its scene, like turnedAndTilted(): rotation about its depth axis
// (rotate), then about its own lateral axis (tilt, or fan). The apex is fixed.
struct PlaneTilt {
  double tilt_rad = 0, rotate_rad = 0;
};

inline constexpr double kMostTilt_deg =
    20;  // largest accepted limit; our choice: beyond lies another view
// Throws SceneError naming --tilt unless it is from 0 to kMostTilt_deg.
void checkTilt(double tilt_deg);

// A beat of a scene's motion that can be cut with any tilt of its plane.
class TiltableModel {
 public:
  // Like modelLoop(). Runs in parallel.
  TiltableModel(const Scene& scene, const MeshMotion& motion, int frames,
                std::optional<WallSegments> segments = {});
  // Thread-safe. Runs in parallel.
  ModelLoop at(const PlaneTilt& tilt) const;

 private:
  Scene scene_;
  std::vector<SurfaceTopology> surfaces_;
  std::vector<SurfaceFrame> frames_;
  std::optional<WallSegments> segments_;
  double systole_ = 0;
};

// Transforms surfaces into the frame of a tilted probe.
void tiltSurfaces(const PlaneTilt& tilt, std::vector<SurfaceFrame>& frames);

using ModelAtTilt = std::function<ModelLoop(const PlaneTilt&)>;  // thread-safe

struct TiltFound {
  PlaneTilt tilt;
  double most_deg = 0;  // requested limit, either way
  PoseFound found;      // pose at that tilt
  double untilted = 1;  // D of the plane without tilt
  // Eq. 8 of descent.h for each angle. Rivals differ by half of the range in that angle; the
  // baseline is the median of all planes of the lattice.
  double tilt_confidence = 0, rotate_confidence = 0;
  bool at_limit = false;
  int planes = 0;     // planes evaluated, each with its own pose: the cost of the search
  double cpu_ms = 0;  // CPU time of the search
};

// Tilt and rotation of lowest D, each within `most_deg` degrees: a lattice of 25 planes, then
// Newton's method from the best two that lie at least 5 degrees apart. Each plane takes the pose of
// lowest D near `start`, the pose without tilt, so D is continuous in the model. Runs in parallel;
// the result does not depend on the threads. Throws JobError when the monitor requests a stop.
// Precondition: most_deg > 0.
TiltFound searchTilt(const ModelAtTilt& model, const ModelDiscrepancy& discrepancy,
                     const PoseFound& start, double most_deg, const Monitor& monitor = {});

// The same for a simulator's heart, from its best pose without tilt.
TiltFound searchTilt(const Simulator& model, const ModelDiscrepancy& discrepancy, double most_deg,
                     const Monitor& monitor = {});

}  // namespace echocine::fit
