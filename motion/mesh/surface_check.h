#pragma once
// Requirements for the faces of a structure as a whole.

#include "motion/mesh/mesh.h"
#include "motion/mesh/mesh_fault.h"
#include "scene/scene.h"

namespace echocine {

// Faces with three different corners, edges with at most two faces. Unless the structure is a
// membrane, adjacent faces have opposite edge directions, and there are no open edges and no bow
// ties. Throws MeshFault that starts with the structure's place and names a face, a remedy, and the
// `repair` word that removes this fault alone.
void checkEdges(const Structure& structure, const KeyframeMesh& keyframe);

// Every separate closed surface looks outward, unless it is the wall of a cavity in another. Throws
// like checkEdges. Precondition: passed checkEdges, no membrane.
void checkPieces(const Structure& structure, const KeyframeMesh& keyframe);

// repair = ["word"]; empty if the structure already has it.
RepairOffer offerOf(bool has_it, const char* word);

}  // namespace echocine
