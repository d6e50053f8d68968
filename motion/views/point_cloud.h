#pragma once
// What a surface's vertices say as a cloud of points.

#include <cstddef>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace echocine {

// Precondition: at least one point.
Vec3d middleOf(std::span<const Vec3d> points);

// At most `most` of them, evenly spread over their order.
std::vector<Vec3d> thinned(std::vector<Vec3d> points, std::size_t most);

// Where two surfaces meet: the middle of those points of `a` that are nearer to `b` than the least
// distance and `margin` more; and that least distance. Preconditions: neither is empty.
struct Contact {
  Vec3d middle;
  double gap = 0;
};
Contact contactOf(std::span<const Vec3d> a, std::span<const Vec3d> b, double margin);

}  // namespace echocine
