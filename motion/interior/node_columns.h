#pragma once
// The columns of a lattice's node, kLanes * kFloatLanes floats, and sums of them over a row.

#include <cstddef>
#include <vector>

#include "core/lanes.h"
#include "motion/interior/sparse_rows.h"

namespace echocine {

template <std::size_t kLanes>
struct NodeColumns {
  Floats8 lanes[kLanes];

  static NodeColumns at(const std::vector<float>& from, std::size_t node) {
    NodeColumns columns;
    for (std::size_t i = 0; i < kLanes; ++i)
      columns.lanes[i] = lanesAt(&from[(node * kLanes + i) * kFloatLanes]);
    return columns;
  }
  void add(float factor, const std::vector<float>& from, std::size_t node) {
    for (std::size_t i = 0; i < kLanes; ++i)
      lanes[i] += factor * lanesAt(&from[(node * kLanes + i) * kFloatLanes]);
  }
  void subtract(const NodeColumns& other) {
    for (std::size_t i = 0; i < kLanes; ++i) lanes[i] -= other.lanes[i];
  }
  void putTo(std::vector<float>& to, std::size_t node, float factor = 1) const {
    for (std::size_t i = 0; i < kLanes; ++i)
      store(factor * lanes[i], &to[(node * kLanes + i) * kFloatLanes]);
  }

  // sum_i values[i] x[members[i]] over members [begin, end) of a row. The sum has two chains, since
  // an addition takes several cycles. The last member is added last.
  static NodeColumns product(const SparseRows<float>::Row& row, std::size_t begin, std::size_t end,
                             const std::vector<float>& x) {
    NodeColumns even{}, odd{};
    std::size_t i = begin;
    if (((end - begin) & 1) != 0) {
      even.add(row.values[i], x, row.members[i]);
      ++i;
    }
    for (; i < end; i += 2) {
      even.add(row.values[i], x, row.members[i]);
      odd.add(row.values[i + 1], x, row.members[i + 1]);
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) even.lanes[lane] += odd.lanes[lane];
    return even;
  }
  // The same, from the last member to the first, which is added last.
  static NodeColumns productBack(const SparseRows<float>::Row& row, std::size_t begin,
                                 std::size_t end, const std::vector<float>& x) {
    NodeColumns even{}, odd{};
    std::size_t i = end;
    if (((end - begin) & 1) != 0) {
      --i;
      even.add(row.values[i], x, row.members[i]);
    }
    for (; i > begin; i -= 2) {
      even.add(row.values[i - 1], x, row.members[i - 1]);
      odd.add(row.values[i - 2], x, row.members[i - 2]);
    }
    for (std::size_t lane = 0; lane < kLanes; ++lane) even.lanes[lane] += odd.lanes[lane];
    return even;
  }
};

}  // namespace echocine
