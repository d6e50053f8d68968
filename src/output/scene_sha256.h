#pragma once
// The identity of a scene and its meshes.

#include <string>

#include "motion/surfaces/mesh_motion.h"
#include "scene/scene.h"

namespace echocine {

// SHA-256 over the resolved scene, its media, its meshes and the program's version: equal for two
// runs that must write the same files. The version counts, because two versions may differ in a
// last digit; the location of files does not.
std::string sceneSha256(const Scene& scene, const MeshMotion& motion);

}  // namespace echocine
