#pragma once
// Where a mesh's vertices are in the world.

#include "core/vec3.h"
#include "scene/motion_settings.h"

namespace echocine {

// Metres that one mesh unit measures.
inline double metresPerMeshUnit(const MotionSettings& motion) {
  return motion.mesh_unit_m * motion.mesh_scale;
}

// A vertex in mesh units -> world, m: unit, then factor, then offset.
inline Vec3d worldPlace(const MotionSettings& motion, Vec3d vertex) {
  return metresPerMeshUnit(motion) * vertex + motion.mesh_offset_m;
}

}  // namespace echocine
