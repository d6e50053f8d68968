#pragma once
// Places of the left ventricle's wall, with tabulated properties of its shape.

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec3.h"
#include "motion/heart/meridian.h"

namespace echocine::heart {

// A place independent of dials and time. Computing it takes longer than moving it, so it is cached.
struct WallPlace {
  double phi_rad, zeta, rho;          // at end-diastole
  double centre_x, centre_y;          // of the section, relative to the length
  double flat;                        // sqrt of the ratio of the section's semi-axes, x to y
  double participation;               // in the contraction; the ring is stiff
  double thickness, thickness_about;  // relative to the septum, by height and by angle
  double outward;                     // of the outline's normal, for girth 1
  // How far the place is towards the apex: -1 at the mitral ring, 1 at the apex, and -1/2 and 1/2
  // at the two heights that conicity compares.
  double lean;
  // Shares of SectionShape: of a bow, 1 halfway and 0 at the ring and the apex; of an ellipticity,
  // 1 from kOvalHeight on and 0 at the ring, whose valves keep their shape.
  double bow, oval;
  // The outline on either side of the place, for its normal; rho is negative beyond an end.
  struct Beside {
    double rho, lean;
  } before, after;
  // Segments with a weight, in their order, and the weights. Unused entries have weight 0.
  std::array<std::uint8_t, 4> segment;
  std::array<double, 4> share;
};

// Meshes of the ventricle's surfaces are geodesicSphere(kWallFrequency).
inline constexpr int kWallFrequency = 12;

// The outline of the cavity at end-diastole, over zeta, of a heart with the outline's own conicity.
// Another conicity multiplies its radii by exp(taper lean).
const Meridian& wallOutline();
double leanOf(double zeta);

inline constexpr double kOvalHeight = 0.3;  // zeta; our choice
// Heights of the diameters that conicity compares, apical / basal: zeta. Our choice; the outline's
// own ratio is then near the mean of the source of heart_indices.h.
inline constexpr double kBasalHeight = 1.0 / 3, kApicalHeight = 2.0 / 3;
double outlineConicity();

// The outline of a taper from -2 to 1 (beyond, that of the limit): volume and largest radius,
// relative to the length, and the derivatives of their logarithms by the taper. Tabulated: within
// 1e-6 of a sum over 511 heights.
struct OutlineSize {
  double volume, widest;
  double volume_slope, widest_slope;
};
OutlineSize outlineSize(double taper);

WallPlace wallPlaceOf(Vec3d direction);              // of the unit sphere, (0, 0, 1) being the apex
WallPlace wallPlaceAt(double phi_rad, double zeta);  // without normal

// Places of the directions of geodesicSphere(kWallFrequency).
const std::vector<WallPlace>& meshPlaces();

}  // namespace echocine::heart
