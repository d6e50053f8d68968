#pragma once
// Places of the left ventricle's wall, and what each has from the tables of its shape.

#include <array>
#include <cstdint>
#include <vector>

#include "core/vec3.h"
#include "motion/heart/meridian.h"

namespace echocine::heart {

// What a place is before any dial or instant: to look it up takes longer than to move it.
struct WallPlace {
  double phi_rad, zeta, rho;          // at end-diastole
  double centre_x, centre_y;          // of the section, as shares of the length
  double flat;                        // sqrt of the section's semi-axes' ratio, x to y
  double participation;               // in the contraction: the ring is stiff
  double thickness, thickness_about;  // over that of the septum, by height and by angle
  double outward, rise;               // of the outline's normal, at girth 1
  // The segments that have a say, in their order, and how much. Those left over have none.
  std::array<std::uint8_t, 4> segment;
  std::array<double, 4> share;
};

// Meshes of the ventricle's surfaces are geodesicSphere(kWallFrequency).
inline constexpr int kWallFrequency = 12;

// The outline of the cavity at end-diastole, over zeta.
const Meridian& wallOutline();

WallPlace wallPlaceOf(Vec3d direction);              // of the unit sphere, (0, 0, 1) being the apex
WallPlace wallPlaceAt(double phi_rad, double zeta);  // no normal

// Of the directions of geodesicSphere(kWallFrequency).
const std::vector<WallPlace>& meshPlaces();

}  // namespace echocine::heart
