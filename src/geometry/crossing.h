#pragma once
// What a ray meets: plain records between the geometry and the trace stage.

#include <cstdint>
#include <vector>

#include "core/ids.h"
#include "core/vec3.h"

namespace echocine {

using InsideSet = SurfaceSet;  // the closed surfaces that hold a point

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
  Vec3d facet_normal{};  // with smooth normals: the facet's own; else zero, `normal` is the facet's
};

// What a ray meets, sorted by distance (ties by surface), and the states at its start as its
// crossings prove them: along a ray the states of a closed surface alternate and end outside.
struct RayCrossings {
  std::vector<Crossing> crossings;
  InsideSet inside;
};

}  // namespace echocine
