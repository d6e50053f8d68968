#pragma once
// A heart's axes and valves, detected from the surfaces that a scene has. This folder's README has
// the rules and their limits.

#include <string>
#include <vector>

#include "core/error.h"
#include "core/vec3.h"
#include "motion/views/role_surfaces.h"
#include "motion/views/standard_pose.h"

namespace echocine {

struct HeartMarks {
  HeartFrame frame;
  bool aortic_found = false;      // false: placed as in an average heart
  Facets outside_m;               // the heart without the great vessels
  Facets front_m;                 // the same without the atria, whose appendages lie beside a probe
  double wall_m = 0;              // thickness of a missing wall around these surfaces
  std::vector<std::string> told;  // guesses due to missing roles, in words
};

// Throws SceneError at `place` without a left ventricle, or for contradictory roles.
HeartMarks findHeart(const std::vector<RoleSurface>& surfaces, const SourcePlace& place);

}  // namespace echocine
