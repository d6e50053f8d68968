#pragma once
// The layout of a sparse matrix from control points to refined points: rows, their order and
// sources. The meaning of the weights is the caller's.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace echocine {

// A control point in one vector register (an extension of GCC and Clang; without it the compiler
// adds the three coordinates separately). The fourth lane is unused.
using PaddedPoint [[gnu::vector_size(16)]] = float;

// Valid until the thread's next call.
const PaddedPoint* padded(std::span<const Vec3f> points);

// Rows of equal length are adjacent: otherwise a product takes a quarter longer, because the
// processor mispredicts the ends of rows.
class StencilRows {
 public:
  struct Group {
    std::uint32_t length;  // weights per row
    std::size_t first_row, last_row;
  };

  StencilRows() = default;
  // Row v has sizes[v] entries; the entries of all rows follow each other in `sources`.
  StencilRows(std::span<const int> sizes, std::span<const int> sources);

  // One value per entry, in this layout's order.
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
