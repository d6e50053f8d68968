#pragma once
// Splits surfaces that meet in edges of more than two faces into sheets.

#include "motion/repair/repair_mesh.h"

namespace echocine {

struct NonManifoldSplit {
  std::size_t edges = 0;     // split edges of more than two faces
  std::size_t dropped = 0;   // faces of flaps, inner walls and fins, and duplicates
  std::size_t vertices = 0;  // added
};

// Splits the surface at every edge of more than two faces, and at every bow-tie vertex. The faces
// around such an edge are paired by angle in the first keyframe, so that the inside lies between
// the two of a pair. The same split applies to all keyframes and moves no face.
//
// Duplicate faces are removed first (duplicates.h), except in membranes. An odd number of faces at
// an edge cannot be paired into closed sheets, so one adjacent sheet is dropped: preferably an open
// one (a flap), otherwise a closed one (a wall between two chambers), in each case the smallest by
// area (our choice). The largest sheet of a mesh always stays. A sheet pinched along an edge whose
// both ends it also surrounds stays joined there, and is rejected later.
NonManifoldSplit splitNonManifold(RepairMesh& mesh, bool membrane);

}  // namespace echocine
