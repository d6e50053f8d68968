#include "fit/boundary_sides.h"

#include <cmath>
#include <numbers>

namespace echocine::fit {

std::vector<BoundaryMiddle> middlesOf(const ModelFrame& frame, std::size_t structures) {
  std::vector<BoundaryMiddle> out(structures);
  for (const BoundaryPoint& p : frame.boundary) {
    BoundaryMiddle& m = out[p.surface];
    m.x_m += static_cast<double>(p.length_m) * p.x_m;
    m.z_m += static_cast<double>(p.length_m) * p.z_m;
    m.length_m += static_cast<double>(p.length_m);
  }
  for (BoundaryMiddle& m : out)
    if (m.length_m > 0) m.x_m /= m.length_m, m.z_m /= m.length_m;
  return out;
}

SideShares sidesOf(const BoundaryPoint& piece, const BoundaryMiddle& middle) {
  const double turns = std::atan2(piece.x_m - middle.x_m, piece.z_m - middle.z_m) /
                           (2 * std::numbers::pi) +
                       1,
               side = turns * kSides, share = side - std::floor(side);
  const auto first = static_cast<int>(std::floor(side)) % kSides;
  return {static_cast<std::size_t>(first), static_cast<std::size_t>((first + 1) % kSides), share};
}

}  // namespace echocine::fit
