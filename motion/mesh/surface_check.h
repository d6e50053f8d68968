#pragma once
// What a structure's faces must be together.

#include "motion/mesh/mesh.h"
#include "scene/scene.h"

namespace echocine {

// Edges with at most two faces, which run them in opposite directions. Unless the structure is a
// membrane also no open edge and no vertex at which surfaces meet in that point only. Throws
// SceneError that starts with the structure's place and names a face, what to do, and the word of
// `repair` that would mend it.
void checkEdges(const Structure& structure, const KeyframeMesh& keyframe);

// Every separate closed surface looks outward, unless it is the wall of a cavity in another. Throws
// as checkEdges does. Precondition: passed checkEdges, no membrane.
void checkPieces(const Structure& structure, const KeyframeMesh& keyframe);

// ", or set repair = ["word"]"; nothing where the structure has it already.
std::string repairHint(bool has_it, const char* word);

}  // namespace echocine
