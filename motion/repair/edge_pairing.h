#pragma once
// The faces around one edge, in pairs.

#include <span>
#include <utility>
#include <vector>

#include "core/vec3.h"
#include "motion/mesh/edge_sides.h"

namespace echocine {

// The sides of one edge in pairs of neighbours by angle around it. If equal numbers of faces run
// the edge up and down, each pair has the inside of the surface between its two, as in two bodies
// that touch along the edge. Otherwise orientation is inconsistent, and the pairs with the smallest
// angles are chosen; one side of an odd number remains. Depends on positions only, not on the order
// of faces.
std::vector<std::pair<std::uint32_t, std::uint32_t>> pairsAround(
    std::span<const Side> edge, std::span<const Triangle> triangles,
    std::span<const Vec3d> positions);

}  // namespace echocine
