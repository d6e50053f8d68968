#pragma once
// PLY, OFF and STL through OpenMesh.

#include <string>

#include "motion/mesh/mesh.h"

namespace echocine {

// Parses the bytes of a file; extension is "ply", "off" or "stl". The readers deliver coordinates
// in single precision whatever the file holds. STL corners with exactly equal coordinates become
// one vertex, and STL triangles with two equal corners vanish. Throws SceneError. Not to be called
// by two threads at once: the library's readers are singletons with state.
TriangleMesh parseWithOpenMesh(const std::string& bytes, const std::string& extension);

}  // namespace echocine
