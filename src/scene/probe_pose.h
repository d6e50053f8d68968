#pragma once
// A probe's pose as scene files write it, both ways.

#include <optional>
#include <string>

#include "core/vec3.h"
#include "scene/scene.h"

namespace echocine {

// Of any two directions that are not along each other, of any length but 0: `lateral` is made
// perpendicular to `axis`, and the elevation axis completes a right-handed frame. None where they
// are along each other.
std::optional<Pose> poseOf(Vec3d apex_m, Vec3d axis, Vec3d lateral);

// The focus of a probe that names none: half its depth.
double defaultFocus(double depth_m);

// A pose that its own text gives back to the last bit, within 1e-6 of a direction and 0.1 um of
// `pose`; the depth likewise, in tenths of a millimetre.
Pose writable(const Pose& pose, double mesh_unit_m);
double writableDepth(double depth_m);

// The keys of [probe] that place it, as lines to paste: apex, axis, lateral, sector_deg, depth_mm,
// frequency_mhz. With as many digits as give the pose back; 17 where fewer do not.
std::string poseToml(const Scene& scene);

}  // namespace echocine
