#pragma once
// The 17 segments of the left ventricle (Cerqueira et al., Circulation 105, 539-542, 2002).

#include <array>
#include <cstddef>

#include "core/vec3.h"

namespace echocine {

constexpr std::size_t kAhaSegments = 17;

inline constexpr std::array<const char*, kAhaSegments> kAhaNames{"basal anterior",
                                                                 "basal anteroseptal",
                                                                 "basal inferoseptal",
                                                                 "basal inferior",
                                                                 "basal inferolateral",
                                                                 "basal anterolateral",
                                                                 "mid anterior",
                                                                 "mid anteroseptal",
                                                                 "mid inferoseptal",
                                                                 "mid inferior",
                                                                 "mid inferolateral",
                                                                 "mid anterolateral",
                                                                 "apical anterior",
                                                                 "apical septal",
                                                                 "apical inferior",
                                                                 "apical lateral",
                                                                 "apex"};

// The left ventricle's directions: unit vectors, the axis from base to apex, the others
// perpendicular to it.
struct HeartAxes {
  Vec3d base_m, axis, septal, anterior;
  double length_m = 0;  // from the base to the apex

  double zeta(Vec3d place_m) const {  // 0 at the base, 1 at the apex
    return dot(place_m - base_m, axis) / length_m;
  }
};

// 1 to 17: thirds of the length, six sectors, four at the apex, and a cap, here the last tenth.
int ahaSegment(const HeartAxes& axes, Vec3d place_m);

// Do two segments, 1 to 17, share a border, in a ring or along the wall? None does with itself.
bool areAdjacent(std::size_t a, std::size_t b);

}  // namespace echocine
