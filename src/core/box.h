#pragma once

#include <algorithm>
#include <limits>

#include "core/vec3.h"

namespace echocine {

// An axis-aligned box; empty until a point is added.
struct Box {
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  Vec3d lo{kFar, kFar, kFar}, hi{-kFar, -kFar, -kFar};

  void add(Vec3d p) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  bool contains(Vec3d p) const {
    return p.x >= lo.x && p.y >= lo.y && p.z >= lo.z && p.x <= hi.x && p.y <= hi.y && p.z <= hi.z;
  }
  bool meets(const Box& other) const {
    return lo.x <= other.hi.x && lo.y <= other.hi.y && lo.z <= other.hi.z && hi.x >= other.lo.x &&
           hi.y >= other.lo.y && hi.z >= other.lo.z;
  }
};

}  // namespace echocine
