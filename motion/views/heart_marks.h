#pragma once
// A heart's axes and valves, found from whichever of its surfaces a scene has. The rules and their
// limits are in the README of this folder.

#include <string>
#include <vector>

#include "core/error.h"
#include "core/vec3.h"
#include "motion/views/role_points.h"
#include "motion/views/standard_pose.h"

namespace echocine {

struct HeartMarks {
  HeartFrame frame;
  bool aortic_found = false;      // else the valve stands where other hearts have it
  std::vector<Vec3d> outside_m;   // of what belongs to the heart; the great vessels left out
  std::vector<Vec3d> front_m;     // of these without the atria, whose appendages lie beside a probe
  double wall_m = 0;              // that is missing around these points
  std::vector<std::string> told;  // what was guessed for want of a role, in words
};

// Throws SceneError at `place`: no left ventricle, or roles that contradict one another.
HeartMarks findHeart(const std::vector<RoleSurface>& surfaces, const SourcePlace& place);

}  // namespace echocine
