#pragma once
// The layout of a sparse matrix that makes refined points of control points: which rows, in which
// order, from which sources. What the weights mean is the user's business.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace echocine {

// A control point in one vector register (an extension GCC and Clang share; left to itself the
// compiler adds the three coordinates one by one). The fourth lane is idle.
using PaddedPoint [[gnu::vector_size(16)]] = float;

// Valid until the thread's next call.
const PaddedPoint* padded(std::span<const Vec3f> points);

// Rows of equal length stand one after the other: a product takes a quarter longer when the
// processor cannot foresee where a row ends.
class StencilRows {
 public:
  struct Group {
    std::uint32_t length;  // weights per row
    std::size_t first_row, last_row;
  };

  StencilRows() = default;
  // Row v has sizes[v] entries; those of all rows follow each other in `sources`.
  StencilRows(std::span<const int> sizes, std::span<const int> sources);

  // A value per entry, put into this order.
  std::vector<float> arranged(std::span<const int> sizes, std::span<const float> values) const;

  const std::vector<Group>& groups() const { return groups_; }
  const std::vector<std::uint32_t>& rows() const { return rows_; }  // the v of each row
  const std::vector<std::uint32_t>& sources() const { return sources_; }

 private:
  std::vector<Group> groups_;
  std::vector<std::uint32_t> rows_;
  std::vector<std::uint32_t> sources_;
};

}  // namespace echocine
