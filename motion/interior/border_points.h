#pragma once
// Points of the visible surfaces, and the two groups that meet at each.

#include <cstdint>
#include <span>
#include <vector>

#include "motion/interior/motion_field.h"
#include "motion/interior/top_surfaces.h"

namespace echocine {

// A point of a surface as a mean of the corners of one triangle. For a vertex all three are the
// vertex itself.
struct BorderPoint {
  SurfaceId surface{};
  std::uint32_t corners[3]{};
  float shares[3]{};
  Vec3f reference_m;
  // The surface on the other side, which wins where this one ends; the number of surfaces for the
  // background.
  std::uint32_t beyond = 0;
};

// All vertices of closed surfaces within `region` that no stronger surface hides at the reference
// phase, and points between them in triangles larger than `spacing_m`. reference_m: by surface, its
// vertices at the reference phase.
std::vector<BorderPoint> borderPoints(std::span<const InteriorSurface> surfaces,
                                      std::span<const std::vector<Vec3f>> reference_m,
                                      const TopSurfaces& tops, const Box& region, double spacing_m);

// A point of a surface with its vertices at `positions_m`.
inline Vec3f placeOf(const BorderPoint& point, std::span<const Vec3f> positions_m) {
  return point.shares[0] * positions_m[point.corners[0]] +
         point.shares[1] * positions_m[point.corners[1]] +
         point.shares[2] * positions_m[point.corners[2]];
}

}  // namespace echocine
