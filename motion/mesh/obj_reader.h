#pragma once
// Wavefront OBJ, the vertices, faces, creases and corners of it.

#include <string_view>

#include "motion/mesh/mesh.h"

namespace echocine {

// Reads `v`, `f` and `t` (see obj_tags.h) statements; every other statement is skipped. Polygons
// become fans. Negative indices count back from the newest vertex. Throws SceneError that starts
// with the line's number: the library's reader works in single precision, silently skips vertices
// it cannot parse (which shifts the numbers of all that follow) and silently drops faces that use a
// vertex twice.
TriangleMesh parseObj(std::string_view text);

}  // namespace echocine
