#pragma once
// What a structure's faces must be together.

#include "motion/mesh/mesh.h"
#include "motion/mesh/mesh_fault.h"
#include "scene/scene.h"

namespace echocine {

// Faces with three different corners, edges with at most two faces. Unless the structure is a
// membrane, which has no side that could be wrong, the two run their edge in opposite directions,
// and there is no open edge and no vertex at which surfaces meet in that point only. Throws
// MeshFault that starts with the structure's place and names a face, what to do, and the word of
// `repair` that mends this fault alone.
void checkEdges(const Structure& structure, const KeyframeMesh& keyframe);

// Every separate closed surface looks outward, unless it is the wall of a cavity in another. Throws
// as checkEdges does. Precondition: passed checkEdges, no membrane.
void checkPieces(const Structure& structure, const KeyframeMesh& keyframe);

// repair = ["word"]; nothing where the structure has it already.
RepairOffer offerOf(bool has_it, const char* word);

}  // namespace echocine
