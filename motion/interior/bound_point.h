#pragma once
// Points bound to a surface: exact combinations of the corners of their triangle.

#include <cstdint>
#include <span>
#include <vector>

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

// The nearest point of a surface to each of `points_m`. Precondition: at least one triangle.
std::vector<BoundPoint> bindToSurface(SurfaceId surface, std::span<const Triangle> triangles,
                                      std::span<const Vec3f> positions_m,
                                      std::span<const Vec3f> points_m);

}  // namespace echocine
