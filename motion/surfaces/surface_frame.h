#pragma once
// Output of the motion stage: the surfaces of one instant, in the probe frame, m.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "core/vec3.h"
#include "scene/triangle_mesh.h"

namespace echocine {

// A triangle with its index in its surface.
struct NumberedTriangle {
  Triangle corners;
  std::uint32_t number = 0;
};

// Successive triangles of a surface.
struct TriangleRange {
  std::uint32_t first = 0, end = 0;
};

// Constant over a loop.
struct SurfaceTopology {
  SurfaceId id{};
  std::vector<Triangle> triangles;
  std::uint32_t vertex_count = 0;
  bool membrane = false;  // an open sheet: encloses nothing
  bool still = false;     // one keyframe: the same in every frame
  // With smooth normals: the index of the normal of each corner of each triangle. Empty if it is
  // the vertex index.
  std::vector<Triangle> normal_corners{};
  // A superset of the triangles that the imaging plane cuts at any phase, ascending, if known.
  std::optional<std::vector<NumberedTriangle>> near_plane{};

  const std::vector<Triangle>& normalCorners() const {
    return normal_corners.empty() ? triangles : normal_corners;
  }
};

// One instant. positions_m[s] has vertex_count entries for the surface with index s. Probe frame:
// the imaging plane is y = 0 and the apex is the origin, so single precision resolves nanometres
// anywhere in the world.
struct SurfaceFrame {
  std::vector<std::vector<Vec3f>> positions_m;
  // Smooth normals, indexed by SurfaceTopology::normalCorners(): unit, outward; zero without a
  // normal. Empty if the scene uses facet normals.
  std::vector<std::vector<Vec3f>> normals{};
  // By surface, ascending: a superset of the triangles that the imaging plane cuts. Empty if
  // unknown.
  std::vector<std::vector<TriangleRange>> near_plane{};
};

}  // namespace echocine
