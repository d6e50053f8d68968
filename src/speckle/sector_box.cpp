#include "speckle/sector_box.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echocine {

SectorBox sectorBox(const Probe& probe, double disc_m, double moves_m, double edge_m) {
  const double reach_m = probe.face_radius_m + probe.max_depth_m;
  const double behind_m = probe.isFullTurn() ? reach_m : 0;
  const SectorBox::Range deep{-behind_m - moves_m, reach_m + moves_m};
  if (!probe.isFan()) {
    const double half_m = moves_m + edge_m +
                          std::max(std::abs(probe.first_offset_m), std::abs(probe.last_offset_m)) +
                          reach_m * std::abs(std::tan(probe.first_angle_rad));
    return {{-half_m, half_m}, deep};
  }
  // sees() takes a disc's half angle for q / sqrt(1 - q^2), q = radius / r, and 1e-4 rad more: over
  // twice its radius away from the centre that is 1.16 radii; nearer by, any direction is seen.
  const double margin_m = 1.2 * disc_m + edge_m + 1e-4 * reach_m;
  const double nearest_m = probe.face_radius_m + probe.min_depth_m;
  const double about_m = nearest_m <= 3 * disc_m ? 2 * disc_m : 0;
  const double beside_rad =
      probe.lines > 1 ? (probe.last_angle_rad - probe.first_angle_rad) / (probe.lines - 1) : 0.1;
  constexpr double kRight = std::numbers::pi / 2;
  SectorBox::Range x{-about_m, about_m}, z{about_m > 0 ? -about_m : reach_m, about_m};
  const double first = probe.first_angle_rad - beside_rad;
  const double last = probe.last_angle_rad + beside_rad;
  for (const double angle : {first, std::clamp(-kRight, first, last), std::clamp(0.0, first, last),
                             std::clamp(kRight, first, last), last})
    for (const double r_m : {nearest_m, reach_m}) {
      const double across_m = r_m * std::sin(angle), along_m = r_m * std::cos(angle);
      x = {std::min(x.low_m, across_m), std::max(x.high_m, across_m)};
      z = {std::min(z.low_m, along_m), std::max(z.high_m, along_m)};
    }
  const double half_m = moves_m + reach_m + edge_m;
  return {{std::max(x.low_m - margin_m, -half_m), std::min(x.high_m + margin_m, half_m)},
          {std::max(z.low_m - margin_m, deep.low_m), std::min(z.high_m + margin_m, deep.high_m)}};
}

}  // namespace echocine
