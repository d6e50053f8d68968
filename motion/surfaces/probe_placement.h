#pragma once
// A probe placed by the heart's anatomy.

#include <memory>
#include <utility>

#include "motion/surfaces/mesh_motion.h"
#include "scene/scene.h"

namespace echocine {

// The scene with the pose of its view found from its structures with roles, at end-diastole: the
// keyframe of the largest left ventricle. Pose, and depth and focus where the scene names none, are
// those that poseToml() writes, so that a scene with these lines instead is the same to the last
// bit. A scene without a view comes back as it is. What had to be guessed is added to its warnings.
// Reads those meshes. Throws SceneError naming the scene's place: no role to find the view by,
// roles that contradict one another, a sector that cuts no mesh; and as readKeyframes().
Scene placed(Scene scene);

// The same, and the motion of its meshes in that probe's frame.
std::pair<Scene, std::shared_ptr<const MeshMotion>> placedWithMotion(Scene scene);

// A pose turned about its depth axis, then tilted about its lateral axis; its origin stays. Turning
// takes lateral towards elevation, tilting takes depth towards elevation.
Pose turnedAndTilted(const Pose& pose, double rotate_rad, double tilt_rad);

}  // namespace echocine
