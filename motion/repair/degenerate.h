#pragma once
// Degenerate faces: without area in every keyframe, or duplicates.

#include "motion/repair/repair_mesh.h"

namespace echocine {

struct DroppedFaces {
  std::size_t collapsed = 0;   // with two corners at one place
  std::size_t duplicates = 0;  // with the same corners as another
  std::size_t flipped =
      0;  // three collinear corners: their long edge was flipped into the neighbour
};

// Edges without length in every keyframe are collapsed and their faces dropped, which keeps a
// closed surface closed. Then duplicates.h and flat_faces.h follow.
DroppedFaces dropDegenerate(RepairMesh& mesh);

}  // namespace echocine
