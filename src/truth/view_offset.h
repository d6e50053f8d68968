#pragma once
// The standard view of the imaging plane, and its deviation from it.

#include <optional>
#include <span>

#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/surface_frame.h"
#include "motion/views/heart_marks.h"

namespace echocine {

// Angles and lengths are 0 for the standard plane itself.
struct ViewOffset {
  // a4c, a2c, a3c, plax, psax-base, psax-mid, psax-apex, subcostal, tee-4c, other
  const char* label = "other";
  // Between the ventricle's long axis and the imaging plane; in short axes, between the normals of
  // the standard and of the imaging plane.
  double tilt_deg = 0;
  // About the long axis, from the standard plane; none in short axes.
  std::optional<double> rotation_deg;
  // Distance of the standard plane's centre from the imaging plane. In short axes along the
  // standard plane's normal, positive if the imaging plane is nearer to the apex.
  double shift_mm = 0;
  // The long axis that the standard plane shows minus the one that the imaging plane shows; none in
  // short axes.
  std::optional<double> foreshortening_mm;
};

// The deviation from the planes that place a probe (standardPlane()). `heart` is at end-diastole,
// in the probe frame. `cavity` is that of the left ventricle at `positions_m`, at the same instant
// and in the same frame. "psax-base" needs an aortic valve.
ViewOffset viewOffset(const HeartMarks& heart, const SurfaceTopology& cavity,
                      std::span<const Vec3f> positions_m);

// The same of a scene; none without the roles of a heart. Precondition: the motion is in the probe
// frame.
std::optional<ViewOffset> viewOffset(const Scene& scene, const MeshMotion& motion);

}  // namespace echocine
