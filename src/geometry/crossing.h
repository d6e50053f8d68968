#pragma once
// Intersections of a ray with surfaces: plain records between the geometry and the trace stage.

#include <cstdint>
#include <vector>

#include "core/ids.h"
#include "core/vec3.h"

namespace echocine {

using InsideSet = SurfaceSet;  // the closed surfaces that contain a point

struct Ray {
  Vec3d origin;     // probe frame, m
  Vec3d direction;  // unit length
};

struct Crossing {
  double distance_m = 0;  // along the ray, > 0
  Vec3d normal;           // unit, outward from a closed surface; otherwise the membrane's own side
  SurfaceId surface{};
  std::uint32_t triangle = 0;
  bool entering = false;  // into a closed surface; through a membrane's front
  Vec3d facet_normal{};   // with smooth normals: the facet's own; otherwise zero, and `normal` is
                          // the facet's
};

// The crossings of a ray, sorted by distance (ties by surface), and the states at its start as
// implied by the crossings: along a ray the states of a closed surface alternate and end outside.
struct RayCrossings {
  std::vector<Crossing> crossings;
  InsideSet inside;
};

}  // namespace echocine
