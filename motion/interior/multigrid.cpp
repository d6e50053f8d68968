#include "motion/interior/multigrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/lanes.h"

namespace echocine {

namespace {

// The last level is solved by a dense factor. Our choice: it costs less than one more level.
constexpr std::size_t kLastNodes = 160;

// A coarse node is coupled with those up to two steps away: (1 + 2 + 1) / 2 where the finer rows
// reach two and shares reach one.
constexpr int kReach = 2, kSide = 2 * kReach + 1;
using Slots = std::array<double, static_cast<std::size_t>(kSide* kSide* kSide)>;

struct Place {
  int x, y, z;
};

Place placeOf(const ActiveNodes& nodes, std::size_t number) {
  const auto node = static_cast<int>(nodes.nodes[number]);
  return {node % nodes.nx, node / (nodes.nx * nodes.nz), node / nodes.nx % nodes.nz};
}

// A row's members and their parents stand among 4 x 4 x 4 coarse nodes from this far below half of
// its own place; its own parents are the middle ones of these.
constexpr int kBelow = 1, kNear = 4;
using Near = std::array<double, static_cast<std::size_t>(kNear* kNear* kNear)>;
// Places in Near differ by what their keys differ by.
int keyOf(Place at) {
  return (at.y * kNear + at.z) * kNear + at.x;
}

using Lattice = Multigrid::Lattice;

// The nodes of the next lattice and each node's shares in them.
class Coarsening {
 public:
  Coarsening(const ActiveNodes& nodes, const SparseRows<double>& rows)
      : nodes_(nodes), rows_(rows) {
    coarse_.nodes = {nodes.nx / 2 + 1, nodes.ny / 2 + 1, nodes.nz / 2 + 1, {}, {}};
    markNodes();
    parents_.reserve(rows.size(), 4 * rows.size());  // 3.4 on average
    for (std::size_t n = 0; n < rows.size(); ++n) {
      if (isCoupled(n))
        forParents(n, [&](int x, int y, int z, double share) {
          parents_.add(static_cast<std::uint32_t>(coarse_.nodes.numberAt(x, y, z)), share);
        });
      parents_.endRow();
    }
  }

  SparseRows<float> parents() const { return SparseRows<float>(parents_); }

  // P^T A P with the rows A and the shares P. A coarse row is the sum over the fine nodes that have
  // it for a parent. If none of them has changed, the row is that of `earlier`, which has the same
  // nodes; null: all are new. `changed` becomes the coarse rows that are new.
  Lattice coarse(const Lattice* earlier, std::vector<bool>& changed) {
    const std::size_t size = coarse_.nodes.nodes.size();
    wanted_.assign(size, earlier == nullptr);
    for (std::size_t n = 0; earlier != nullptr && n < rows_.size(); ++n)
      if (changed[n])
        for (const std::uint32_t parent : parents_[n].members) wanted_[parent] = true;
    std::vector<Slots> slots(size, Slots{});
    for (std::size_t n = 0; n < size; ++n) keys_.push_back(keyOf(placeOf(coarse_.nodes, n)));
    for (std::size_t n = 0; n < rows_.size(); ++n) addRow(n, slots);
    coarse_.rows.reserve(size, size * std::tuple_size_v<Slots> / 2);
    for (std::size_t n = 0; n < size; ++n) {
      if (wanted_[n])
        endRow(n, slots[n]);
      else
        coarse_.rows.add(earlier->rows[n]);
    }
    changed = std::move(wanted_);
    return std::move(coarse_);
  }

  const ActiveNodes& coarseNodes() const { return coarse_.nodes; }

 private:
  bool isCoupled(std::size_t n) const { return rows_[n].members.size() > 1; }

  void endRow(std::size_t n, const Slots& slots) {
    const Place at = placeOf(coarse_.nodes, n);
    std::size_t slot = 0;
    for (int y = at.y - kReach; y <= at.y + kReach; ++y)
      for (int z = at.z - kReach; z <= at.z + kReach; ++z)
        for (int x = at.x - kReach; x <= at.x + kReach; ++x, ++slot)
          if (slots[slot] != 0)
            coarse_.rows.add(static_cast<std::uint32_t>(coarse_.nodes.numberAt(x, y, z)),
                             slots[slot]);
    coarse_.rows.endRow();
  }

  // An even node stands on one node of the next lattice, an odd one between two, along each axis.
  template <typename Visit>
  void forParents(std::size_t n, const Visit& visit) const {
    const Place at = placeOf(nodes_, n);
    const auto half = [](int i) { return (i & 1) != 0 ? 0.5 : 1.0; };
    const double share = half(at.x) * half(at.y) * half(at.z);
    for (int y = at.y / 2; y <= (at.y + 1) / 2; ++y)
      for (int z = at.z / 2; z <= (at.z + 1) / 2; ++z)
        for (int x = at.x / 2; x <= (at.x + 1) / 2; ++x) visit(x, y, z, share);
  }

  void markNodes() {
    ActiveNodes& nodes = coarse_.nodes;
    nodes.number.assign(nodes.at(nodes.nx - 1, nodes.ny - 1, nodes.nz - 1) + 1, -1);
    for (std::size_t n = 0; n < rows_.size(); ++n)
      if (isCoupled(n))
        forParents(n, [&](int x, int y, int z, double) { nodes.number[nodes.at(x, y, z)] = 0; });
    for (std::size_t i = 0; i < nodes.number.size(); ++i) {
      if (nodes.number[i] < 0) continue;
      nodes.number[i] = static_cast<std::int32_t>(nodes.nodes.size());
      nodes.nodes.push_back(static_cast<std::uint32_t>(i));
    }
  }

  // A P of the row, then P^T of that.
  void addRow(std::size_t n, std::vector<Slots>& slots) {
    const auto row = rows_[n];
    const auto mine = parents_[n];
    if (std::ranges::none_of(mine.members, [&](std::uint32_t at) { return wanted_[at]; })) return;
    const Place at = placeOf(nodes_, n);
    const int first = keyOf({at.x / 2 - kBelow, at.y / 2 - kBelow, at.z / 2 - kBelow});
    Near near{};
    for (std::size_t i = 0; i < row.members.size(); ++i) {
      const auto theirs = parents_[row.members[i]];
      for (std::size_t b = 0; b < theirs.members.size(); ++b)
        near[static_cast<std::size_t>(keys_[theirs.members[b]] - first)] +=
            row.values[i] * theirs.values[b];
    }
    for (std::size_t a = 0; a < mine.members.size(); ++a)
      addNear(near, keys_[mine.members[a]] - first, mine.values[a], slots[mine.members[a]]);
  }

  // The products with the nodes of `near`, by the share of the one with this place in it.
  static void addNear(const Near& near, int place, double share, Slots& slots) {
    const int x = place % kNear, z = place / kNear % kNear, y = place / (kNear * kNear);
    for (int ny = 0; ny < kNear; ++ny)
      for (int nz = 0; nz < kNear; ++nz) {
        const double* const from = &near[static_cast<std::size_t>(keyOf({0, ny, nz}))];
        double* const to = &slots[static_cast<std::size_t>(
            ((ny - y + kReach) * kSide + nz - z + kReach) * kSide - x + kReach)];
        store(lanesAt(to) + share * lanesAt(from), to);
      }
  }

  const ActiveNodes& nodes_;
  const SparseRows<double>& rows_;
  Lattice coarse_;
  std::vector<bool> wanted_;  // coarse rows; slots of others are incomplete
  SparseRows<double> parents_;
  std::vector<int> keys_;  // by coarse node
};

Multigrid::Level levelOf(const SparseRows<double>& rows) {
  Multigrid::Level level;
  level.rows = SparseRows<float>(rows);
  level.inverse_diagonal.reserve(rows.size());
  level.diagonal_at.reserve(rows.size());
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const auto row = rows[n];
    const auto at = static_cast<std::size_t>(
        std::lower_bound(row.members.begin(), row.members.end(), n) - row.members.begin());
    level.inverse_diagonal.push_back(static_cast<float>(1 / row.values[at]));
    level.diagonal_at.push_back(static_cast<std::uint8_t>(at));
  }
  return level;
}

// Where rounding leaves no positive pivot, the node keeps its diagonal: the factor stays that of a
// positive matrix.
std::vector<float> choleskyFactor(const SparseRows<double>& rows) {
  const std::size_t n = rows.size();
  std::vector<double> l(n * n, 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = rows[i];
    for (std::size_t m = 0; m < row.members.size(); ++m) l[i * n + row.members[m]] = row.values[m];
  }
  for (std::size_t i = 0; i < n; ++i) {
    const double diagonal = l[i * n + i];
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = l[i * n + j];
      for (std::size_t k = 0; k < j; ++k) sum -= l[i * n + k] * l[j * n + k];
      if (i != j)
        l[i * n + j] = sum * l[j * n + j];
      else
        l[i * n + i] = 1 / std::sqrt(sum > 1e-12 * diagonal ? sum : diagonal);
    }
  }
  return {l.begin(), l.end()};
}

}  // namespace

Multigrid::Multigrid(const ActiveNodes& nodes, const SparseRows<double>& rows)
    : Multigrid(nodes, rows, nullptr, {}) {}

Multigrid::Multigrid(const ActiveNodes& nodes, const SparseRows<double>& rows,
                     const Multigrid* earlier, std::vector<bool> changed) {
  const ActiveNodes* fine_nodes = &nodes;
  const SparseRows<double>* fine_rows = &rows;
  levels_.push_back(levelOf(rows));
  while (fine_rows->size() > kLastNodes) {
    Coarsening coarsening(*fine_nodes, *fine_rows);
    levels_.back().parents = coarsening.parents();
    const std::size_t level = coarse_.size();
    // A node that is no longer coupled may leave the lattice, and those below it.
    if (earlier != nullptr &&
        (level >= earlier->coarse_.size() ||
         earlier->coarse_[level].nodes.nodes != coarsening.coarseNodes().nodes))
      earlier = nullptr;
    coarse_.push_back(
        coarsening.coarse(earlier != nullptr ? &earlier->coarse_[level] : nullptr, changed));
    fine_nodes = &coarse_.back().nodes;
    fine_rows = &coarse_.back().rows;
    levels_.push_back(levelOf(*fine_rows));
  }
  last_factor_ = choleskyFactor(*fine_rows);
}

}  // namespace echocine
