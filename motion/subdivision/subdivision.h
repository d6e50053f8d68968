#pragma once
// Loop subdivision: refined vertices as constant weighted sums of control vertices.

#include <cstdint>
#include <span>
#include <vector>

#include "core/error.h"
#include "motion/subdivision/stencil_rows.h"
#include "scene/mesh_tags.h"
#include "scene/triangle_mesh.h"

namespace echocine {

class Subdivision {
 public:
  // Loop's scheme, `levels` times, with creases and corners of the tagged sharpness. Open
  // boundaries and infinitely sharp creases depend on their own vertices only (a cubic B-spline
  // curve), so surfaces that share such a curve still meet. Throws SceneError that starts with the
  // place for more than 50 million triangles or 400 million weights. Preconditions: levels >= 1;
  // edges have at most two faces; tags refer to edges and vertices of the triangles.
  Subdivision(std::span<const Triangle> triangles, std::uint32_t vertex_count, const MeshTags& tags,
              int levels, const SourcePlace& place);

  const std::vector<Triangle>& triangles() const { return triangles_; }  // oriented as the input
  std::uint32_t vertexCount() const { return static_cast<std::uint32_t>(rows_.rows().size()); }

  // The first refined vertices are the control vertices in their order, moved by the scheme.
  // Preconditions: as many control vertices as the input had, refined.size() == vertexCount().
  void apply(std::span<const Vec3f> control, std::span<Vec3f> refined) const;

 private:
  std::vector<Triangle> triangles_;
  StencilRows rows_;
  std::vector<float> weights_;  // one per source
  std::uint32_t control_count_ = 0;
};

}  // namespace echocine
