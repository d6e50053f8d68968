#pragma once
// The fans of triangles around vertices. A vertex at which several fans meet is a bow tie: the
// surface is not manifold there.

#include "motion/mesh/edge_sides.h"

namespace echocine {

// For corner 3 t + k the lowest corner of its fan: corners of one vertex whose triangles are
// connected by edges at it. Precondition: `sides` are those of the triangles.
std::vector<std::uint32_t> cornerFans(std::span<const Triangle> triangles,
                                      const std::vector<Side>& sides);

// The same with connections given by `opposite`: for each side the side it is joined to, or
// kNoSide.
std::vector<std::uint32_t> cornerFans(std::span<const Triangle> triangles,
                                      const std::vector<std::uint32_t>& opposite);

}  // namespace echocine
