#pragma once
// A model's plane turned out of the real picture, as no shift or turn within the picture turns it.

#include <functional>

#include "core/monitor.h"
#include "fit/model_discrepancy.h"

namespace echocine::fit {

// How a probe is held otherwise than its scene says, as turnedAndTilted() turns it: about its depth
// axis (rotate), then about its own lateral axis (tilt, or fan). Its apex stays.
struct PlaneTilt {
  double tilt_rad = 0, rotate_rad = 0;
};

inline constexpr double kMostTilt_deg = 20;  // that may be asked for; our choice: beyond is a view
// Throws SceneError naming --tilt: not from 0 to kMostTilt_deg.
void checkTilt(double tilt_deg);

// A beat of a scene's motion, to be cut by any tilt of its plane.
class TiltableModel {
 public:
  // As modelLoop() has it. Runs in parallel.
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

// Surfaces as a tilted probe has them in its frame.
void tiltSurfaces(const PlaneTilt& tilt, std::vector<SurfaceFrame>& frames);

using ModelAtTilt = std::function<ModelLoop(const PlaneTilt&)>;  // thread-safe

struct TiltFound {
  PlaneTilt tilt;
  double most_deg = 0;  // that was asked for, either way
  PoseFound found;      // there
  double untilted = 1;  // D of the plane as the scene has it
  // Eq. 8 of descent.h, of each angle: rivals lie half of the range away in it, what says nothing
  // is the median of all planes of the lattice.
  double tilt_confidence = 0, rotate_confidence = 0;
  bool at_limit = false;
  int planes = 0;     // that were cut, each with a pose of its own: what the search costs
  double cpu_ms = 0;  // CPU time of that
};

// The tilt and rotation of least D, each within `most_deg` degrees: 25 planes of a lattice, then
// Newton's method from the best two that lie 5 degrees apart. Each plane has the pose of least D
// near that of the untilted one, `start`; so D is continuous in the model. Runs in parallel. The
// same input gives the same tilt whatever the threads. Throws JobError when the monitor wants to
// stop. Precondition: most_deg > 0.
TiltFound searchTilt(const ModelAtTilt& model, const ModelDiscrepancy& discrepancy,
                     const PoseFound& start, double most_deg, const Monitor& monitor = {});

// Of a simulator's heart, from its pose of least D untilted.
TiltFound searchTilt(const Simulator& model, const ModelDiscrepancy& discrepancy, double most_deg,
                     const Monitor& monitor = {});

}  // namespace echocine::fit
