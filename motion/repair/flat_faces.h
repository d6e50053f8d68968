#pragma once
// Faces without area whose corners are three points on a line.

#include "motion/repair/repair_mesh.h"

namespace echocine {

// Exchanges the longest edge of such a face for the other diagonal of both faces at it, so that a
// closed surface stays closed; returns how many were mended. One stays where that would fold the
// surface, double an edge or cut through a crease: no ray meets it.
std::size_t mendFlatFaces(RepairMesh& mesh);

}  // namespace echocine
