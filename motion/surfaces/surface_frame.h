#pragma once
// What the motion stage hands on: the surfaces of one instant, in the probe frame and in metres.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// A triangle with its number in its surface.
struct NumberedTriangle {
  Triangle corners;
  std::uint32_t number = 0;
};

// What never changes over a loop.
struct SurfaceTopology {
  SurfaceId id{};
  std::vector<Triangle> triangles;
  std::uint32_t vertex_count = 0;
  bool membrane = false;  // an open sheet: encloses nothing
  bool still = false;     // one keyframe: the same in every frame
  // With smooth normals: the normal that each corner of each triangle takes. Empty where that is
  // the normal with its vertex's number.
  std::vector<Triangle> normal_corners{};
  // In ascending order at least all triangles that the imaging plane cuts at any phase, where that
  // is known.
  std::optional<std::vector<NumberedTriangle>> near_plane{};

  const std::vector<Triangle>& normalCorners() const {
    return normal_corners.empty() ? triangles : normal_corners;
  }
};

// One instant. positions_m[s] has vertex_count entries for the surface with index s. Probe frame:
// the imaging plane is y = 0, the apex is the origin, so single precision is fine to nanometres
// wherever in the world the scene stands.
struct SurfaceFrame {
  std::vector<std::vector<Vec3f>> positions_m;
  // Smooth normals, by SurfaceTopology::normalCorners(): unit, outward; zero where there is none.
  // No surface has any when the scene wants those of the facets.
  std::vector<std::vector<Vec3f>> normals{};
};

}  // namespace echocine
