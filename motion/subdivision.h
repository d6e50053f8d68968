#pragma once
// Loop subdivision: the refined vertices as fixed weighted sums of control vertices.

#include <cstdint>
#include <span>
#include <vector>

#include "core/error.h"
#include "motion/surface_frame.h"

namespace echocine {

class Subdivision {
 public:
  // Loop's scheme, `levels` times. Open boundaries follow their own boundary vertices (a cubic
  // B-spline curve), so sheets that share a boundary curve still meet. Throws SceneError that
  // starts with the place when more than 50 million triangles would result. Preconditions: levels
  // >= 1; edges have at most two faces.
  Subdivision(std::span<const Triangle> triangles, std::uint32_t vertex_count, int levels,
              const SourcePlace& place);

  const std::vector<Triangle>& triangles() const { return triangles_; }  // oriented as the input
  std::uint32_t vertexCount() const { return static_cast<std::uint32_t>(rows_.size()); }

  // Preconditions: as many control vertices as the input had, refined.size() == vertexCount().
  void apply(std::span<const Vec3f> control, std::span<Vec3f> refined) const;

 private:
  // Rows of equal length, one after the other: a product takes a quarter longer when the processor
  // cannot foresee where a row ends.
  struct Group {
    std::uint32_t length;  // weights per row
    std::size_t first_row, last_row;
  };
  void storeRows(const std::vector<int>& sizes, const std::vector<int>& sources,
                 const std::vector<float>& weights);

  std::vector<Triangle> triangles_;
  // Sparse matrix, its rows sorted by length. Row r makes refined vertex rows_[r], the sum of
  // weight * control[source] over its stretch of weights_ and sources_.
  std::vector<Group> groups_;
  std::vector<std::uint32_t> rows_;
  std::vector<std::uint32_t> sources_;
  std::vector<float> weights_;
  std::uint32_t control_count_ = 0;
};

}  // namespace echocine
