#pragma once
// PLY, OFF and STL through OpenMesh.

#include <string>

#include "motion/mesh/mesh.h"

namespace echocine {

// Parses the bytes of a file; extension is "ply", "off" or "stl". The readers deliver coordinates
// in single precision whatever the file holds. STL corners with exactly equal coordinates become
// one vertex, and STL triangles with two equal corners vanish. Throws SceneError. Threads wait for
// each other.
TriangleMesh parseWithOpenMesh(const std::string& bytes, const std::string& extension);

}  // namespace echocine
