#pragma once
// PLY, OFF and STL through OpenMesh.

#include <string>

#include "motion/mesh/mesh.h"

namespace echocine {

// Parses the bytes of a file; extension is "ply", "off" or "stl". Coordinates are in single
// precision for any file. STL corners with exactly equal coordinates become one vertex; STL
// triangles with two equal corners are dropped. Throws SceneError. Threads wait for each other.
TriangleMesh parseWithOpenMesh(const std::string& bytes, const std::string& extension);

}  // namespace echocine
