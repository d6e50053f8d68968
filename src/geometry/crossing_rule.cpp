#include "geometry/crossing_rule.h"

#include <cmath>

namespace echocine {

RayPlanes::RayPlanes(const Ray& ray) : origin(ray.origin), direction(ray.direction) {
  if (ray.direction.y == 0) {
    v_axis = {0, 1, 0};
  } else {
    const Vec3d helper = std::abs(ray.direction.y) < 0.9 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    v_axis = normalised(helper - dot(helper, direction) * direction);
  }
  u_axis = cross(v_axis, direction);
}

namespace {

// Where the edge p-q passes v = 0. Precondition: v_p and v_q lie on different sides.
template <typename T>
Vec3<T> cutPoint(Vec3<T> p, T v_p, Vec3<T> q, T v_q) {
  const T s = v_q - v_p;
  return {(p.x * v_q - q.x * v_p) / s, (p.y * v_q - q.y * v_p) / s, (p.z * v_q - q.z * v_p) / s};
}

// The vertex k alone on its side, and the other ends of the edges where the cut begins and ends.
struct Turn {
  std::uint8_t k, from, to;
};

// By which vertices are above, vertex 0 in the lowest bit. Seen along a ray a front face runs
// clockwise: with k above, the cut begins on the edge to the vertex that follows it. A table, since
// no branch could be foretold.
constexpr Turn kTurns[8] = {{},        {0, 1, 2}, {1, 2, 0}, {2, 1, 0},
                            {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {}};

}  // namespace

std::optional<TriangleCut> cutTriangle(Vec3d p0, Vec3d p1, Vec3d p2, double v0, double v1,
                                       double v2) {
  const unsigned above = (v0 >= 0 ? 1u : 0u) | (v1 >= 0 ? 2u : 0u) | (v2 >= 0 ? 4u : 0u);
  if (above == 0 || above == 7) return std::nullopt;
  const Vec3d p[3] = {p0, p1, p2};
  const double v[3] = {v0, v1, v2};
  const auto [k, from, to] = kTurns[above];
  return TriangleCut{cutPoint(p[k], v[k], p[from], v[from]), cutPoint(p[k], v[k], p[to], v[to])};
}

std::optional<CutCrossing> crossCut(const RayPlanes& ray, const TriangleCut& cut) {
  const Vec3d from = cut.from - ray.origin, to = cut.to - ray.origin;
  const double u1 = dot(ray.u_axis, from), u2 = dot(ray.u_axis, to);
  const bool right1 = u1 >= 0, right2 = u2 >= 0;
  if (right1 == right2) return std::nullopt;
  const double w1 = dot(ray.direction, from), w2 = dot(ray.direction, to);
  const double distance = (w1 * u2 - w2 * u1) / (u2 - u1);
  if (!(distance > 0)) return std::nullopt;
  return CutCrossing{distance, right1};
}

Vec3d facetNormal(Vec3d area_normal, const TriangleCut& cut, Vec3d v_axis) {
  const double size = length(area_normal);
  if (size > 0) return (1 / size) * area_normal;
  const Vec3d across = cross(cut.to - cut.from, v_axis);
  const double across_size = length(across);
  return across_size > 0 ? (1 / across_size) * across : v_axis;
}

std::optional<Crossing> crossTriangle(const RayPlanes& ray, Vec3f p0, Vec3f p1, Vec3f p2,
                                      SurfaceId surface, std::uint32_t triangle) {
  const Vec3d q0 = toDouble(p0), q1 = toDouble(p1), q2 = toDouble(p2);
  const auto height = [&](Vec3d q) { return dot(ray.v_axis, q - ray.origin); };
  const std::optional<TriangleCut> cut =
      cutTriangle(q0, q1, q2, height(q0), height(q1), height(q2));
  if (!cut) return std::nullopt;
  const std::optional<CutCrossing> crossing = crossCut(ray, *cut);
  if (!crossing) return std::nullopt;
  return Crossing{crossing->distance_m, facetNormal(areaNormal(q0, q1, q2), *cut, ray.v_axis),
                  surface, triangle, crossing->entering};
}

namespace {

using Point = Vec3<Doubles4>;

Point toLanes(const Vec3<Floats4>& p) {
  return {__builtin_convertvector(p.x, Doubles4), __builtin_convertvector(p.y, Doubles4),
          __builtin_convertvector(p.z, Doubles4)};
}
Point toLanes(Vec3d p) {
  return {Doubles4{} + p.x, Doubles4{} + p.y, Doubles4{} + p.z};
}
Point choose(Mask4 mask, const Point& a, const Point& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

}  // namespace

// cutTriangle(), crossCut() and facetNormal() without a branch.
LaneCrossings crossTriangles(const RayPlanes& ray, const std::array<Vec3<Floats4>, 3>& corners) {
  const Doubles4 zero{};
  const Point p0 = toLanes(corners[0]), p1 = toLanes(corners[1]), p2 = toLanes(corners[2]);
  const Point origin = toLanes(ray.origin), u_axis = toLanes(ray.u_axis),
              v_axis = toLanes(ray.v_axis), direction = toLanes(ray.direction);
  const Doubles4 v0 = dot(v_axis, p0 - origin), v1 = dot(v_axis, p1 - origin),
                 v2 = dot(v_axis, p2 - origin);
  const Mask4 above0 = v0 >= zero, above1 = v1 >= zero, above2 = v2 >= zero;
  const Mask4 cut01 = above0 ^ above1, cut02 = above0 ^ above2;
  // Two of the edges 0-1, 1-2 and 2-0 are cut: one of the first two, and one of the last two.
  const Point one = cutPoint(p1, v1, choose(cut01, p0, p2), Doubles4(cut01 ? v0 : v2)) - origin;
  const Point other = cutPoint(p2, v2, choose(cut02, p0, p1), Doubles4(cut02 ? v0 : v1)) - origin;
  const Doubles4 u1 = dot(u_axis, one), u2 = dot(u_axis, other);
  const Doubles4 w1 = dot(direction, one), w2 = dot(direction, other);
  const Mask4 right1 = u1 >= zero, right2 = u2 >= zero;
  const Doubles4 distance = (w1 * u2 - w2 * u1) / (u2 - u1);
  const Mask4 crossed = (cut01 | cut02) & (right1 ^ right2) & (distance > zero);

  const Point area = cross(p1 - p0, p2 - p0);
  const Doubles4 per_size = 1.0 / squareRoot(dot(area, area));
  return {crossed, above0 == right1, distance, per_size * area};
}

}  // namespace echocine
