#pragma once
// Checks the header of a PLY file before OpenMesh, whose reader trusts headers and crashes on wrong
// ones.

#include <string_view>

namespace echocine {

// Throws SceneError unless the header is well-formed and describes vertices with x, y, z, then
// faces with one list of vertex indices, and neither count exceeds the size of the file.
void checkPlyHeader(std::string_view bytes);

}  // namespace echocine
