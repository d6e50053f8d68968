#pragma once
// Faces that look to one side, the outer one.

#include "motion/repair/repair_mesh.h"

namespace echocine {

// Turns faces so that those of each piece (edge_sides.h) are oriented alike, as most of them
// already are, and returns how many were turned. Unless it is a membrane's, a piece then looks
// outward by the sign of its volume in the first keyframe, an open one as if a fan closed it. A
// piece that lies inside another is the wall of a cavity and looks into it; one inside that is
// solid again. Throws SceneError, without place, of a surface with one side only.
std::size_t orientFaces(RepairMesh& mesh, bool membrane);

}  // namespace echocine
