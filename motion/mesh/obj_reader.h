#pragma once
// Wavefront OBJ: vertices, faces, creases and corners.

#include <string_view>

#include "motion/mesh/mesh.h"

namespace echocine {

// Reads `v`, `f` and `t` (see obj_tags.h) statements; others are skipped. Polygons become fans.
// Negative indices count back from the newest vertex. Throws SceneError that starts with the line's
// number. OpenMesh's reader is not used: it has single precision, silently skips unreadable
// vertices (which shifts later numbers) and silently drops faces that use a vertex twice.
TriangleMesh parseObj(std::string_view text);

}  // namespace echocine
