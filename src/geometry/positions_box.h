#pragma once
// The box about the vertices of a surface.

#include <vector>

#include "core/box.h"

namespace echocine {

// In metres, as the positions. Empty without any.
Box boxOf(const std::vector<Vec3f>& positions_m);

}  // namespace echocine
