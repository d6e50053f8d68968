#pragma once
// The nearest place of a triangle mesh.

#include <span>
#include <vector>

#include "core/nearest_vertex.h"
#include "scene/triangle_mesh.h"

namespace echocine {

class NearestOnSurface {
 public:
  // Keeps copies. Preconditions: at least one vertex; triangles refer to them.
  NearestOnSurface(std::span<const Triangle> triangles, std::span<const Vec3f> points_m);

  // The nearest place of the triangles about the nearest vertex; of a vertex without triangles, the
  // vertex. Thread-safe.
  Vec3d to(Vec3f place_m) const;

 private:
  std::vector<Triangle> triangles_;
  std::vector<Vec3f> points_m_;
  NearestVertex vertices_;
  std::vector<std::uint32_t> starts_, around_;  // triangles about each vertex
};

}  // namespace echocine
