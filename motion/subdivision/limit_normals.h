#pragma once
// Unit normals of the Loop limit surface at the vertices of a refined mesh, from the control mesh.

#include <cstdint>
#include <span>
#include <vector>

#include "core/error.h"
#include "motion/subdivision/stencil_rows.h"
#include "scene/mesh_tags.h"
#include "scene/triangle_mesh.h"

namespace echocine {

class LimitNormals {
 public:
  // At the vertices after `levels` levels of Subdivision (0: the control mesh), in its numbering.
  // Where an infinitely sharp crease or corner splits the tangent plane, each face has the normal
  // of its own side. Throws SceneError like Subdivision, for more than 128 faces at a vertex, and
  // if fractional creases need too many levels to become smooth. Preconditions: levels >= 0, and
  // those of Subdivision.
  LimitNormals(std::span<const Triangle> triangles, std::uint32_t vertex_count,
               const MeshTags& tags, int levels, const SourcePlace& place);

  // The index of the normal of each corner of each refined triangle; empty if it is the vertex
  // index everywhere.
  const std::vector<Triangle>& corners() const { return corners_; }
  std::uint32_t normalCount() const { return normal_count_; }

  // Preconditions: as many control vertices as the input had, normals.size() == normalCount().
  // Outward by the orientation of triangles; zero where the limit surface has no normal, and for
  // vertices without faces.
  void apply(std::span<const Vec3f> control, std::span<Vec3f> normals) const;

 private:
  struct Tangents {
    float du, dv;  // weights of a source in the two tangents
  };

  StencilRows rows_;
  std::vector<Tangents> weights_;
  std::vector<std::uint32_t> normal_of_stencil_;
  std::vector<Triangle> corners_;
  std::uint32_t normal_count_ = 0, control_count_ = 0;
};

}  // namespace echocine
