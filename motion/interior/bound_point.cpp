#include "motion/interior/bound_point.h"

namespace echocine {

Vec3f place(const BoundPoint& point, std::span<const Triangle> triangles,
            std::span<const Vec3f> positions_m) {
  const Triangle& t = triangles[point.triangle];
  return (1 - point.b1 - point.b2) * positions_m[t[0]] + point.b1 * positions_m[t[1]] +
         point.b2 * positions_m[t[2]];
}

}  // namespace echocine
