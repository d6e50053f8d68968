#include "motion/interior/lattice_slabs.h"

#include <algorithm>
#include <cmath>

namespace echocine {

std::pair<std::uint32_t, std::uint32_t> nodesWithin(const GroupLattice& lattice,
                                                    std::pair<float, float> y_range_m) {
  const LatticeGrid& grid = lattice.grid;
  const auto slabOf = [&](float y, int beyond) {
    const float slab = std::floor((y - grid.origin_m.y) / grid.spacing_m);
    const auto last = static_cast<float>(grid.ny);  // clamped before it need fit an integer
    return std::clamp(static_cast<int>(std::clamp(slab, -last, last)) + beyond, 0, grid.ny);
  };
  const int first = slabOf(y_range_m.first, 0), end = slabOf(y_range_m.second, 2);
  return {lattice.slab_starts[static_cast<std::size_t>(first)],
          lattice.slab_starts[static_cast<std::size_t>(std::max(first, end))]};
}

}  // namespace echocine
