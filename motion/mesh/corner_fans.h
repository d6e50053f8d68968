#pragma once
// The fans of triangles around vertices. A vertex at which several fans meet in that point only is
// a bow tie: no surface runs through it.

#include "motion/mesh/edge_sides.h"

namespace echocine {

// For corner 3 t + k the lowest corner of its fan: corners of one vertex whose triangles hang
// together by edges at it. Precondition: `sides` are those of the triangles.
std::vector<std::uint32_t> cornerFans(std::span<const Triangle> triangles,
                                      const std::vector<Side>& sides);

// The same where not edges but `opposite` says what hangs together: for each side the one it is
// joined to, or kNoSide.
std::vector<std::uint32_t> cornerFans(std::span<const Triangle> triangles,
                                      const std::vector<std::uint32_t>& opposite);

}  // namespace echocine
