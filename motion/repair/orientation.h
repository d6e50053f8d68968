#pragma once
// Consistent outward orientation of faces.

#include "motion/repair/repair_mesh.h"

namespace echocine {

// Flips faces so that those of each piece (edge_sides.h) have the orientation of its majority, and
// returns the number of flips. Unless it belongs to a membrane, a piece then looks outward by the
// sign of its volume in the first keyframe, an open one as if closed by a fan. A piece inside
// another is the wall of a cavity and looks into it; one inside that is solid again. Throws
// SceneError, without place, for a one-sided surface.
std::size_t orientFaces(RepairMesh& mesh, bool membrane);

}  // namespace echocine
