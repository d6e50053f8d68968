#pragma once
// The outline of an open sheet of triangles.

#include <cstdint>
#include <utility>
#include <vector>

#include "motion/surfaces/surface_frame.h"

namespace echocine {

// Directed boundary edges, as pairs of vertices, in ascending order.
using SheetOutline = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// The sheet is oriented. The result is empty if the mesh is closed, or if an edge is used twice in
// one direction.
SheetOutline outlineOf(const std::vector<Triangle>& faces);

}  // namespace echocine
