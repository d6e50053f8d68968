#pragma once
// A probe placed by anatomy.

#include <memory>
#include <utility>

#include "motion/surfaces/mesh_motion.h"
#include "scene/scene.h"

namespace echocine {

// The scene with the pose of its view computed from its structures with roles, at end-diastole: the
// keyframe of the largest left ventricle. Pose, and default depth and focus, are those that
// poseToml() writes, so a scene with these lines is equal to the last bit. A scene without a view
// is returned unchanged. Guesses are added to its warnings. Reads those meshes. Throws SceneError
// naming the scene's place for a missing role, contradictory roles, or a sector that cuts no mesh;
// and like readKeyframes().
Scene placed(Scene scene);

// The same, with the motion of its meshes in the probe's frame.
std::pair<Scene, std::shared_ptr<const MeshMotion>> placedWithMotion(Scene scene);

// A pose rotated about its depth axis, then tilted about its lateral axis; its origin is fixed.
// Rotation moves lateral towards elevation, tilt moves depth towards elevation.
Pose turnedAndTilted(const Pose& pose, double rotate_rad, double tilt_rad);

}  // namespace echocine
