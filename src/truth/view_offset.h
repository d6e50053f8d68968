#pragma once
// The standard view of the imaging plane, and its deviation from it.

#include <optional>
#include <span>

#include "motion/surfaces/surface_frame.h"
#include "truth/aha_segments.h"

namespace echocine {

// Angles and lengths are 0 for the standard plane itself.
struct ViewOffset {
  // a4c, a2c, a3c, plax, psax-base, psax-mid, psax-apex, subcostal, other
  const char* label = "other";
  // Between the ventricle's long axis and the imaging plane; in short axes, the plane's normal.
  double tilt_deg = 0;
  // About the long axis, from the standard plane; none in short axes.
  std::optional<double> rotation_deg;
  // Distance of the ventricle's centre from the imaging plane; in short axes along the long axis,
  // from the centre of the visible third.
  double shift_mm = 0;
  // The true long axis minus the one visible in the plane; none in short axes.
  std::optional<double> foreshortening_mm;
};

// Centres of the existing rings.
struct ViewLandmarks {
  HeartAxes axes;
  std::optional<Vec3d> tricuspid_m, aortic_m;
};

// Standard planes contain the long axis. The four-chamber plane also contains the centre of the
// tricuspid ring, or else of the right ventricle. The two-chamber plane is rotated by 60 degrees
// from it. The long-axis plane contains the centre of the aortic ring, or else is rotated by -60
// degrees. Rotations are from the lateral towards the anterior wall. `cavity` at `positions_m`,
// probe frame.
ViewOffset viewOffset(const ViewLandmarks& marks, const SurfaceTopology& cavity,
                      std::span<const Vec3f> positions_m);

}  // namespace echocine
