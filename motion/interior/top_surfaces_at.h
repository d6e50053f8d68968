#pragma once
// The top surfaces of many places that are near each other.

#include <optional>
#include <span>

#include "motion/interior/top_surfaces.h"

namespace echocine {

// tops[i] = surfaces.at(places_m[i]). The places are divided into octants, so that few surfaces
// have a border near each: the smaller the box about all places, the faster. Precondition: equal
// sizes.
void topSurfacesAt(const TopSurfaces& surfaces, std::span<const Vec3f> places_m,
                   std::span<std::optional<SurfaceId>> tops);

}  // namespace echocine
