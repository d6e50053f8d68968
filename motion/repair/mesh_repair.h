#pragma once
// Repairs of a structure's meshes by a scene's `repair` words.

#include <span>
#include <string>
#include <vector>

#include "motion/mesh/mesh.h"
#include "scene/scene.h"

namespace echocine {

// Welds, drops degenerate faces, orients, splits sheets and fills holes, in this order and as
// requested, in all keyframes together. The faces of a membrane are always oriented consistently,
// and vertices without a face are always dropped: they are no part of the surface. Returns a report
// line that starts with the structure's place; empty if no requested repair changed the meshes.
// Throws SceneError like checkKeyframes if keyframes have different faces, or the result is no
// surface. Precondition: at least one keyframe, of files that passed checkFile.
std::string repairKeyframes(const Structure& structure, std::vector<KeyframeMesh>& keyframes);

}  // namespace echocine
