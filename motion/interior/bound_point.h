#pragma once
// Points bound to a surface: exact combinations of the corners of their triangle.

#include <cstdint>
#include <span>

#include "core/ids.h"
#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

struct BoundPoint {
  SurfaceId surface{};
  std::uint32_t triangle = 0;
  float b1 = 0, b2 = 0;  // barycentric coordinates of the second and third corner
};

// Its position for vertices at `positions_m`.
Vec3f place(const BoundPoint& point, std::span<const Triangle> triangles,
            std::span<const Vec3f> positions_m);

}  // namespace echocine
