#pragma once
// The header of a PLY file, checked before OpenMesh sees it: its reader trusts headers and crashes
// on what they get wrong.

#include <string_view>

namespace echocine {

// Throws SceneError unless the header is well-formed and describes vertices with x, y, z, then
// faces with one list of vertex indices, no more of either than the file has bytes.
void checkPlyHeader(std::string_view bytes);

}  // namespace echocine
