#pragma once
// Faces without area whose three corners are collinear.

#include "motion/repair/repair_mesh.h"

namespace echocine {

// Flips the longest edge of such a face, so that a closed surface stays closed; returns the number
// repaired. A face stays if the flip would fold the surface, duplicate an edge or cut a crease: no
// ray meets it.
std::size_t mendFlatFaces(RepairMesh& mesh);

}  // namespace echocine
