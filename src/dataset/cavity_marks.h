#pragma once
// Position and axes of a heart's left ventricle at one instant.

#include "motion/heart/recording.h"
#include "motion/surfaces/mesh_motion.h"

namespace echocine::dataset {

// World, metres.
struct CavityMarks {
  Vec3d apex, mitral;                         // apex of the cavity, and centre of the ring
  Vec3d lateral{1, 0, 0}, anterior{0, 1, 0};  // unit, perpendicular to the long axis
};

// For a recorded heart, at its keyframe nearest to a phase.
CavityMarks marksOf(const heart::Recording& recording, double phase);

// For any heart whose structures have roles. Precondition: `motion` is the scene's. Throws
// SceneError for contradictory roles.
CavityMarks marksOf(const Scene& scene, const MeshMotion& motion, double phase);

}  // namespace echocine::dataset
