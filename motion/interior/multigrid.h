#pragma once
// An approximate inverse of a lattice's equations: one V-cycle of geometric multigrid, for many
// columns at once. It is symmetric and positive, as conjugate gradients need it.

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "motion/interior/lattice_fit.h"
#include "motion/interior/sparse_rows.h"

namespace echocine {

class Multigrid {
 public:
  // rows: symmetric, positive definite, by active node.
  Multigrid(const ActiveNodes& nodes, const SparseRows<double>& rows);
  // The same if rows differ from those of `earlier` only where `changed` is true: coarse rows that
  // these do not enter are taken from there. Same bits as the constructor above.
  Multigrid(const ActiveNodes& nodes, const SparseRows<double>& rows, const Multigrid* earlier,
            std::vector<bool> changed);

  // One lattice. Each next one has every second node along each axis.
  struct Level {
    SparseRows<float> rows;
    std::vector<float> inverse_diagonal;
    std::vector<std::uint8_t> diagonal_at;  // by row, the place of the diagonal among its members
    // By node, the nodes of the next level between which it stands, and their trilinear shares;
    // a node that is coupled with none has none. Empty on the last level.
    SparseRows<float> parents;
  };
  std::span<const Level> levels() const { return levels_; }
  // Cholesky's factor of the last level, L L^T, row by row; the diagonal is inverted.
  std::span<const float> lastFactor() const { return last_factor_; }

  // Rows of a lattice in double precision.
  struct Lattice {
    ActiveNodes nodes;
    SparseRows<double> rows;
  };

 private:
  std::vector<Level> levels_;
  std::deque<Lattice> coarse_;  // from the second level on
  std::vector<float> last_factor_;
};

// Memory of the cycle for kLanes * kFloatLanes columns.
template <std::size_t kLanes>
class MultigridCycle {
 public:
  explicit MultigridCycle(const Multigrid& grid);

  // x = M b; kLanes * kFloatLanes values per node.
  void apply(const std::vector<float>& b, std::vector<float>& x);

 private:
  void descend(std::size_t level, const std::vector<float>& b, std::vector<float>& x);
  void smoothFromZero(const Multigrid::Level& level, const std::vector<float>& b,
                      std::vector<float>& x) const;
  void restrictResidual(const Multigrid::Level& level, const std::vector<float>& x,
                        std::vector<float>& coarse_b) const;
  void addCoarse(const Multigrid::Level& level, const std::vector<float>& coarse_x,
                 std::vector<float>& x) const;
  void smoothBack(const Multigrid::Level& level, const std::vector<float>& b,
                  std::vector<float>& x) const;
  void solveLast(const std::vector<float>& b, std::vector<float>& x) const;

  const Multigrid& grid_;
  std::vector<std::vector<float>> b_, x_;  // by level; of the first none
};

}  // namespace echocine
