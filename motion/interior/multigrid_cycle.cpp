#include <algorithm>

#include "core/lanes.h"
#include "motion/interior/multigrid.h"
#include "motion/interior/node_columns.h"

namespace echocine {

template <std::size_t kLanes>
MultigridCycle<kLanes>::MultigridCycle(const Multigrid& grid) : grid_(grid) {
  for (std::size_t l = 0; l < grid.levels().size(); ++l) {
    const std::size_t count = l > 0 ? grid.levels()[l].rows.size() * kLanes * kFloatLanes : 0;
    b_.emplace_back(count);
    x_.emplace_back(count);
  }
}

template <std::size_t kLanes>
void MultigridCycle<kLanes>::apply(const std::vector<float>& b, std::vector<float>& x) {
  descend(0, b, x);
}

template <std::size_t kLanes>
void MultigridCycle<kLanes>::descend(std::size_t l, const std::vector<float>& b,
                                     std::vector<float>& x) {
  if (l + 1 == grid_.levels().size()) return solveLast(b, x);
  const Multigrid::Level& level = grid_.levels()[l];
  smoothFromZero(level, b, x);
  restrictResidual(level, x, b_[l + 1]);
  descend(l + 1, b_[l + 1], x_[l + 1]);
  addCoarse(level, x_[l + 1], x);
  smoothBack(level, b, x);
}

// Gauss-Seidel sweep upwards. The unknowns above are still 0.
template <std::size_t kLanes>
void MultigridCycle<kLanes>::smoothFromZero(const Multigrid::Level& level,
                                            const std::vector<float>& b,
                                            std::vector<float>& x) const {
  for (std::size_t n = 0; n < level.rows.size(); ++n) {
    auto sum = NodeColumns<kLanes>::at(b, n);
    sum.subtract(NodeColumns<kLanes>::product(level.rows[n], 0, level.diagonal_at[n], x));
    sum.putTo(x, n, level.inverse_diagonal[n]);
  }
}

// After that sweep b - A x at a node is what the nodes above it have added since.
template <std::size_t kLanes>
void MultigridCycle<kLanes>::restrictResidual(const Multigrid::Level& level,
                                              const std::vector<float>& x,
                                              std::vector<float>& coarse_b) const {
  std::fill(coarse_b.begin(), coarse_b.end(), 0.0f);
  for (std::size_t n = 0; n < level.rows.size(); ++n) {
    const auto row = level.rows[n];
    const auto added =
        NodeColumns<kLanes>::product(row, level.diagonal_at[n] + 1u, row.members.size(), x);
    const auto parents = level.parents[n];
    for (std::size_t i = 0; i < parents.members.size(); ++i) {
      auto to = NodeColumns<kLanes>::at(coarse_b, parents.members[i]);
      for (std::size_t lane = 0; lane < kLanes; ++lane)
        to.lanes[lane] -= parents.values[i] * added.lanes[lane];
      to.putTo(coarse_b, parents.members[i]);
    }
  }
}

template <std::size_t kLanes>
void MultigridCycle<kLanes>::addCoarse(const Multigrid::Level& level,
                                       const std::vector<float>& coarse_x,
                                       std::vector<float>& x) const {
  for (std::size_t n = 0; n < level.rows.size(); ++n) {
    const auto parents = level.parents[n];
    auto sum = NodeColumns<kLanes>::at(x, n);
    for (std::size_t i = 0; i < parents.members.size(); ++i)
      sum.add(parents.values[i], coarse_x, parents.members[i]);
    sum.putTo(x, n);
  }
}

// The sweep downwards: the transpose of the first, so the cycle is symmetric.
template <std::size_t kLanes>
void MultigridCycle<kLanes>::smoothBack(const Multigrid::Level& level, const std::vector<float>& b,
                                        std::vector<float>& x) const {
  for (std::size_t n = level.rows.size(); n-- > 0;) {
    const auto row = level.rows[n];
    const std::size_t at = level.diagonal_at[n];
    auto sum = NodeColumns<kLanes>::at(b, n);
    sum.subtract(NodeColumns<kLanes>::product(row, 0, at, x));
    sum.subtract(NodeColumns<kLanes>::productBack(row, at + 1, row.members.size(), x));
    sum.putTo(x, n, level.inverse_diagonal[n]);
  }
}

template <std::size_t kLanes>
void MultigridCycle<kLanes>::solveLast(const std::vector<float>& b, std::vector<float>& x) const {
  const std::span<const float> l = grid_.lastFactor();
  const std::size_t count = grid_.levels().back().rows.size();
  for (std::size_t n = 0; n < count; ++n) {
    auto sum = NodeColumns<kLanes>::at(b, n);
    for (std::size_t m = 0; m < n; ++m) sum.add(-l[n * count + m], x, m);
    sum.putTo(x, n, l[n * count + n]);
  }
  for (std::size_t n = count; n-- > 0;) {
    auto sum = NodeColumns<kLanes>::at(x, n);
    for (std::size_t m = n + 1; m < count; ++m) sum.add(-l[m * count + n], x, m);
    sum.putTo(x, n, l[n * count + n]);
  }
}

template class MultigridCycle<1>;
template class MultigridCycle<2>;
template class MultigridCycle<3>;

}  // namespace echocine
