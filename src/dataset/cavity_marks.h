#pragma once
// Where a heart's left ventricle is and how it lies, at one instant.

#include "motion/heart/recording.h"
#include "motion/surfaces/mesh_motion.h"

namespace echocine::dataset {

// World, metres.
struct CavityMarks {
  Vec3d apex, mitral;                         // the cavity's, and the middle of the ring
  Vec3d lateral{1, 0, 0}, anterior{0, 1, 0};  // unit, across the long axis
};

// Of a recorded heart, at its keyframe nearest to a phase.
CavityMarks marksOf(const heart::Recording& recording, double phase);

// Of any heart whose structures have roles. Precondition: `motion` is the scene's. Throws
// SceneError where the roles contradict one another.
CavityMarks marksOf(const Scene& scene, const MeshMotion& motion, double phase);

}  // namespace echocine::dataset
