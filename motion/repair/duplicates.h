#pragma once
// Duplicate faces.

#include "motion/repair/repair_mesh.h"

namespace echocine {

// If faces have the same corners, the first stays. Both are removed if they are the two sides of a
// fin: opposite directions, on a surface that is complete without them. Returns the number removed.
std::size_t dropDuplicates(RepairMesh& mesh);

}  // namespace echocine
