#pragma once
// What a scene's `repair` words do to the meshes of a structure.

#include <span>
#include <string>
#include <vector>

#include "motion/mesh/mesh.h"
#include "scene/scene.h"

namespace echocine {

// Welds, drops degenerate faces, orients, parts sheets and fills holes, in this order and as far as
// the structure asks for it, in all keyframes alike; the faces of a membrane come out oriented
// alike whether it asks or not. Returns what was done as a line that starts with the structure's
// place; empty when nothing had to be. A mesh that is whole stays as it is. Throws SceneError as
// checkKeyframes does, when keyframes do not have the same faces to begin with, or what is left is
// no surface. Precondition: keyframes of files that passed checkFile, at least one.
std::string repairKeyframes(const Structure& structure, std::vector<KeyframeMesh>& keyframes);

}  // namespace echocine
