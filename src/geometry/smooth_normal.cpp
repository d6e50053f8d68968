#include "geometry/smooth_normal.h"

namespace echocine {

TriangleCut cutNormals(const std::array<Vec3f, 3>& at_corner, double v0, double v1, double v2) {
  return cutTriangle(toDouble(at_corner[0]), toDouble(at_corner[1]), toDouble(at_corner[2]), v0, v1,
                     v2)
      .value_or(TriangleCut{});
}

Vec3d facingNormal(Vec3d value, Vec3d direction, Vec3d facet_normal) {
  const double size = length(value);
  const bool same_side = dot(value, direction) * dot(facet_normal, direction) > 0;
  return size > 0 && same_side ? (1 / size) * value : facet_normal;
}

void makeSmooth(const RayPlanes& ray, const TriangleCut& cut, const TriangleCut& normals,
                Crossing& crossing) {
  const double u1 = dot(ray.u_axis, cut.from - ray.origin),
               u2 = dot(ray.u_axis, cut.to - ray.origin);
  const double share = u1 / (u1 - u2);  // u1 and u2 differ: the cut was crossed
  const Vec3d value = normals.from + share * (normals.to - normals.from);
  crossing.facet_normal = crossing.normal;
  crossing.normal = facingNormal(value, ray.direction, crossing.normal);
}

}  // namespace echocine
