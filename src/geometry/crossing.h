#pragma once
// What a ray meets: plain records between the geometry and the trace stage.

#include <bitset>
#include <cstdint>
#include <vector>

#include "core/ids.h"
#include "core/vec3.h"

namespace echocine {

// The most structures a scene may have: their inside/outside states fit in a few words per ray.
constexpr std::size_t kMaxSurfaces = 256;
using InsideSet = std::bitset<kMaxSurfaces>;  // by SurfaceId

struct Ray {
  Vec3d origin;     // probe frame, m
  Vec3d direction;  // unit length
};

struct Crossing {
  double distance_m = 0;  // along the ray, > 0
  Vec3d normal;           // unit, out of a closed surface; a membrane's own side otherwise
  SurfaceId surface{};
  std::uint32_t triangle = 0;
  bool entering = false;  // into a closed surface; through a membrane's front
};

}  // namespace echocine
