#pragma once
// Bounding box of the vertices of a surface.

#include <vector>

#include "core/box.h"

namespace echocine {

// In metres, like the positions. Empty without vertices.
Box boxOf(const std::vector<Vec3f>& positions_m);

}  // namespace echocine
