#pragma once
// Surfaces that meet in edges of more than two faces, parted into sheets.

#include "motion/repair/repair_mesh.h"

namespace echocine {

struct NonManifoldSplit {
  std::size_t edges = 0;     // of more than two faces, that were parted
  std::size_t dropped = 0;   // faces of flaps, inner walls and fins, and those there twice
  std::size_t vertices = 0;  // that came
};

// Parts the surface at every edge of more than two faces, and at every vertex where surfaces meet
// in that point only. The faces around such an edge are paired by their angles in the first
// keyframe, so that what is inside lies between the two of a pair; the parting holds for all
// keyframes alike and moves no face.
//
// Unless it is a membrane's, faces that are there twice go first (duplicates.h): they enclose
// nothing. An odd number of faces at an edge cannot be paired into closed sheets:
// one of the sheets that end there is dropped: one that is open elsewhere, a flap, before one that
// is not, a wall between two chambers; of these the smallest by area (our choice). The largest
// sheet of a mesh always stays. A sheet pinched along an edge whose both ends it also runs around
// stays joined there, and is refused as before.
NonManifoldSplit splitNonManifold(RepairMesh& mesh, bool membrane);

}  // namespace echocine
