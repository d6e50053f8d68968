#pragma once
// World positions of a mesh's vertices.

#include "core/vec3.h"
#include "scene/motion_settings.h"

namespace echocine {

// Metres per mesh unit.
inline double metresPerMeshUnit(const MotionSettings& motion) {
  return motion.mesh_unit_m * motion.mesh_scale;
}

// A vertex in mesh units -> world, m: unit, then scale, then offset.
inline Vec3d worldPlace(const MotionSettings& motion, Vec3d vertex) {
  return metresPerMeshUnit(motion) * vertex + motion.mesh_offset_m;
}

}  // namespace echocine
