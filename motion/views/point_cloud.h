#pragma once
// Operations on a surface's vertices as a point cloud.

#include <cstddef>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace echocine {

// Precondition: at least one point.
Vec3d middleOf(std::span<const Vec3d> points);

// At most `most` points, evenly spaced in their order.
std::vector<Vec3d> thinned(std::vector<Vec3d> points, std::size_t most);

// Contact of two surfaces: the centre of those points of `a` whose distance to `b` is at most the
// smallest distance plus `margin`; and that smallest distance. Preconditions: neither is empty.
struct Contact {
  Vec3d middle;
  double gap = 0;
};
Contact contactOf(std::span<const Vec3d> a, std::span<const Vec3d> b, double margin);

}  // namespace echocine
