#pragma once
// Faces that are there more than once.

#include "motion/repair/repair_mesh.h"

namespace echocine {

// Of faces with the same corners one stays, the first; both go where they are the two sides of a
// fin, which encloses nothing: they run in opposite directions, and the surface they stand on is
// whole without them. Returns how many went.
std::size_t dropDuplicates(RepairMesh& mesh);

}  // namespace echocine
