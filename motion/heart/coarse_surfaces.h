#pragma once
// A beat in meshes with a quarter of the triangles, for models that are cut thousands of times.

#include "motion/heart/recording.h"

namespace echocine::heart {

// The control meshes become the surfaces themselves, without subdivision. With P a control point
// and Q the vertex that one level of Loop subdivision moves it to, the vertex is
//
//     p = (P + Q) / 2
//
// On an even mesh with edges h on a sphere of radius R and d = h^2 / (2R), Q lies 3/8 d below P.
// Facets lie on average 1/4 d below their vertices, and those of the refined mesh 1/16 d below Q.
// So both surfaces are 7/16 d below P on average. On a crease, which refines to a curve, both
// chords are 7/24 d below. Curvatures add, so the same factor serves all smooth surfaces.
// Precondition: `recording` has control meshes, levels == Recording::kLevels.
Recording coarseSurfaces(Recording recording);

}  // namespace echocine::heart
