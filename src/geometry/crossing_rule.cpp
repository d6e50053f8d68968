#include "geometry/crossing_rule.h"

#include <cmath>

namespace echocine {

RayPlanes::RayPlanes(const Ray& ray) : origin(ray.origin), direction(ray.direction) {
  if (ray.direction.y == 0) {
    v_axis = {0, 1, 0};
  } else {
    const Vec3d helper =
        std::abs(ray.direction.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    v_axis = normalised(helper - dot(helper, direction) * direction);
  }
  u_axis = cross(v_axis, direction);
}

namespace {

// Where the edge p-q passes v = 0. Precondition: v_p and v_q lie on different sides.
Vec3d cutPoint(Vec3d p, double v_p, Vec3d q, double v_q) {
  const double s = v_q - v_p;
  return {(p.x * v_q - q.x * v_p) / s, (p.y * v_q - q.y * v_p) / s, (p.z * v_q - q.z * v_p) / s};
}

// Outward unit normal; a triangle without area takes the normal of its cut in the plane v = 0.
Vec3d facetNormal(const RayPlanes& ray, Vec3d p0, Vec3d p1, Vec3d p2, Vec3d cut, bool entering) {
  const Vec3d n = cross(p1 - p0, p2 - p0);
  const double size = length(n);
  if (size > 0) return (1 / size) * n;
  const Vec3d across = dot(cut, ray.direction) * ray.u_axis - dot(cut, ray.u_axis) * ray.direction;
  const double across_size = length(across);
  const Vec3d unit = across_size > 0 ? (1 / across_size) * across : ray.direction;
  return (dot(unit, ray.direction) < 0) == entering ? unit : -unit;
}

}  // namespace

std::optional<Crossing> crossTriangle(const RayPlanes& ray, Vec3f p0, Vec3f p1, Vec3f p2,
                                      SurfaceId surface, std::uint32_t triangle) {
  const Vec3d p[3] = {toDouble(p0) - ray.origin, toDouble(p1) - ray.origin,
                      toDouble(p2) - ray.origin};
  const double v[3] = {dot(ray.v_axis, p[0]), dot(ray.v_axis, p[1]), dot(ray.v_axis, p[2])};
  const bool above[3] = {v[0] >= 0, v[1] >= 0, v[2] >= 0};
  if (above[0] == above[1] && above[1] == above[2]) return std::nullopt;

  // k is the vertex alone on its side, i and j follow it in the triangle's order.
  const int k = above[1] == above[2] ? 0 : above[0] == above[2] ? 1 : 2;
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const Vec3d c1 = cutPoint(p[k], v[k], p[i], v[i]);
  const Vec3d c2 = cutPoint(p[k], v[k], p[j], v[j]);
  const double u1 = dot(ray.u_axis, c1), u2 = dot(ray.u_axis, c2);
  const bool right1 = u1 >= 0, right2 = u2 >= 0;
  if (right1 == right2) return std::nullopt;

  const double w1 = dot(ray.direction, c1), w2 = dot(ray.direction, c2);
  const double distance = (w1 * u2 - w2 * u1) / (u2 - u1);
  if (!(distance > 0)) return std::nullopt;
  // Seen along the ray a front face runs clockwise, so above the plane its first cut is the right one.
  const bool entering = right1 == above[k];
  return Crossing{distance, facetNormal(ray, p[0], p[1], p[2], c2 - c1, entering), surface, triangle,
                  entering};
}

}  // namespace echocine
