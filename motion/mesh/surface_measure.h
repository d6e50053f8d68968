#pragma once
// Areas and volumes of triangle surfaces, summed in double precision.

#include <array>
#include <concepts>
#include <cstdint>
#include <iterator>
#include <span>
#include <vector>

#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// Along the normal, with twice the area as its length, m^2.
inline Vec3d doubleArea(const Triangle& t, std::span<const Vec3f> positions_m) {
  const Vec3d corner = toDouble(positions_m[t[0]]);
  return cross(toDouble(positions_m[t[1]]) - corner, toDouble(positions_m[t[2]]) - corner);
}

// Volume within a closed surface, positive if its faces look outward; cube of the positions' unit.
// By the divergence theorem, V = 1/6 sum a . (b x c), relative to a vertex of the surface, so that
// distant coordinates do not cancel. Precondition: at least one triangle. `place` returns the
// position of a vertex in double precision.
template <typename Triangles, std::invocable<std::uint32_t> Place>
double enclosedVolume(const Triangles& triangles, const Place& place) {
  const Vec3d reference = place((*std::begin(triangles))[0]);
  double six_volumes = 0;
  for (const Triangle& t : triangles)
    six_volumes +=
        dot(place(t[0]) - reference, cross(place(t[1]) - reference, place(t[2]) - reference));
  return six_volumes / 6.0;
}
// The same for single-precision positions.
double enclosedVolume(std::span<const Triangle> triangles, std::span<const Vec3f> positions_m);

// The volume of one closed surface for repeated evaluation, with half the products. Two triangles
// (a, b, c) and (a, c, d) with a common edge give a . (b x c) + a . (c x d) = a . (c x (d - b)), so
// adjacent triangles of the list are paired. Equal to enclosedVolume() within rounding in double.
class VolumeSum {
 public:
  VolumeSum() = default;
  explicit VolumeSum(std::span<const Triangle> triangles);

  // 0 without triangles.
  double of(std::span<const Vec3f> positions_m) const;

 private:
  // a, b, c, d as above; an unpaired triangle has the reference point as d.
  using Pair = std::array<std::uint32_t, 4>;
  std::vector<Pair> pairs_;
};

}  // namespace echocine
