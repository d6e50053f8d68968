#include "scene/elevation_slices.h"

#include <numbers>

#include "core/check.h"
#include "scene/beam_profile.h"
#include "scene/path_length.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// Roots of the probabilists' Hermite polynomials of degree 3 and 5 and their weights (Abramowitz
// and Stegun, table 25.10, u = sqrt(2) x).
constexpr ElevationNode kOne[] = {{0, 1}};
constexpr ElevationNode kThree[] = {
    {0, 2.0 / 3}, {-1.7320508075688773, 1.0 / 6}, {1.7320508075688773, 1.0 / 6}};
constexpr ElevationNode kFive[] = {{0, 8.0 / 15},
                                   {-1.3556261799742659, 0.22207592200561264},
                                   {1.3556261799742659, 0.22207592200561264},
                                   {-2.8569700138728056, 0.011257411327720688},
                                   {2.8569700138728056, 0.011257411327720688}};

}  // namespace

std::span<const ElevationNode> elevationNodes(int slices) {
  switch (slices) {
    case 1:
      return kOne;
    case 3:
      return kThree;
  }
  CHECK_EQ(slices, 5);
  return kFive;
}

ElevationBell::ElevationBell(const Probe& probe) {
  constexpr double kTwoWays = std::numbers::sqrt2 * kWidthPerDeviation;
  const double wavelength_m = ScanGeometry(probe).wavelength();
  slope_ = followedWidth(1, probe.elevation_aperture_m, wavelength_m) / kTwoWays;
  lens_m_ = probe.elevation_aperture_m / kTwoWays;
  per_focus_ = 1 / probe.elevation_focus_m;
}

// The width's square is a quadratic of the depth that opens upwards: largest at an end.
double elevationReach(const Scene& scene) {
  if (scene.accuracy.elevation_slices == 1) return 0;
  double widest = 0;
  for (const ElevationNode& node : elevationNodes(scene.accuracy.elevation_slices))
    widest = std::max(widest, node.place);
  const ElevationBell bell(scene.probe);
  return widest * std::max(bell.deviation(0), bell.deviation(longestPath(scene)));
}

}  // namespace echocine
