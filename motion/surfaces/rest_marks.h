#pragma once
// The axes and valves of the heart of a scene, where its probe sees them.

#include <optional>

#include "motion/surfaces/mesh_motion.h"
#include "motion/views/heart_marks.h"
#include "scene/scene.h"

namespace echocine {

// Marks at end-diastole: the keyframe of the largest left ventricle.
struct RestMarks {
  HeartMarks heart;  // probe frame, m; the same as those that place a view
  double phase = 0;  // of end-diastole
};

// `motion`: of the scene. None for a scene whose roles do not give a heart (findHeart()).
std::optional<RestMarks> restMarks(const Scene& scene, const MeshMotion& motion);

}  // namespace echocine
