#pragma once
// Faces that are no surface: without area in every keyframe, or there twice.

#include "motion/repair/repair_mesh.h"

namespace echocine {

struct DroppedFaces {
  std::size_t collapsed = 0;   // with two corners at one place
  std::size_t duplicates = 0;  // with the same corners as another
  std::size_t flipped = 0;  // three corners on a line: their long edge turned across the neighbour
};

// Edges without length in every keyframe are drawn to a point and their faces dropped, which leaves
// a closed surface closed; then duplicates.h and flat_faces.h.
DroppedFaces dropDegenerate(RepairMesh& mesh);

}  // namespace echocine
