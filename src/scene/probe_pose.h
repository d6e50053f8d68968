#pragma once
// A probe's pose in the form of scene files, both ways.

#include <optional>
#include <string>

#include "core/vec3.h"
#include "scene/scene.h"

namespace echocine {

// A pose from two directions that are not parallel, of any non-zero length: `lateral` is made
// perpendicular to `axis`, and the elevation axis completes a right-handed frame. None for parallel
// directions.
std::optional<Pose> poseOf(Vec3d apex_m, Vec3d axis, Vec3d lateral);

// The default focus: half the depth.
double defaultFocus(double depth_m);

// A pose that its own text reproduces to the last bit, within 1e-6 of a direction and 0.1 um of
// `pose`; the depth likewise, in tenths of a millimetre.
Pose writable(const Pose& pose, double mesh_unit_m);
double writableDepth(double depth_m);

// The keys of [probe] for its pose, as lines to paste: apex, axis, lateral, sector_deg, depth_mm,
// frequency_mhz. As few digits as reproduce the pose, at most 17.
std::string poseToml(const Scene& scene);

}  // namespace echocine
