#pragma once
// The material points of a scene's meshes.

#include "motion/interior/motion_field.h"
#include "motion/surfaces/mesh_motion.h"

namespace echocine {

// The field of everything that the scene's surfaces move, fitted to them as they are drawn
// (refined). References to neither are kept.
MotionField interiorMotion(const Scene& scene, const MeshMotion& motion,
                           const FieldSettings& settings = {});

}  // namespace echocine
