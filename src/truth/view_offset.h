#pragma once
// Which standard view the imaging plane is, and how far from it it lies.

#include <optional>
#include <span>

#include "motion/surfaces/surface_frame.h"
#include "truth/aha_segments.h"

namespace echocine {

// Angles are 0 and lengths 0 for the standard plane itself.
struct ViewOffset {
  // a4c, a2c, a3c, plax, psax-base, psax-mid, psax-apex, subcostal, other
  const char* label = "other";
  // Of the ventricle's long axis out of the imaging plane; in short axes, out of its normal.
  double tilt_deg = 0;
  // About the long axis, from the standard plane; nothing in short axes.
  std::optional<double> rotation_deg;
  // Of the ventricle's middle from the imaging plane; in short axes along the long axis, from the
  // middle of the third that is shown.
  double shift_mm = 0;
  // Of the long axis as the plane shows it against the true one; nothing in short axes.
  std::optional<double> foreshortening_mm;
};

// Rings' middles as far as the heart has them.
struct ViewLandmarks {
  HeartAxes axes;
  std::optional<Vec3d> tricuspid_m, aortic_m;
};

// Standard planes hold the long axis. The four-chamber plane holds the middle of the tricuspid ring
// too, or else the middle of the right ventricle; the two-chamber plane is turned by 60 degrees
// from it; the long axis holds the middle of the aortic ring, or else is turned by -60 degrees.
// Turns are from the lateral towards the anterior wall. `cavity` at `positions_m`, probe frame.
ViewOffset viewOffset(const ViewLandmarks& marks, const SurfaceTopology& cavity,
                      std::span<const Vec3f> positions_m);

}  // namespace echocine
