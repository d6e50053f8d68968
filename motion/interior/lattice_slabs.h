#pragma once
// The part of a lattice that a range of the elevation axis needs.

#include <cstdint>
#include <utility>

#include "motion/interior/group_lattice.h"

namespace echocine {

// The first active node, and the end, of the slabs about a range of y.
std::pair<std::uint32_t, std::uint32_t> nodesWithin(const GroupLattice& lattice,
                                                    std::pair<float, float> y_range_m);

}  // namespace echocine
