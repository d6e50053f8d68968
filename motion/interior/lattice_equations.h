#pragma once
// The normal equations of a lattice's fit: a sparse row per active node.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "motion/interior/lattice_fit.h"
#include "motion/interior/sparse_rows.h"

namespace echocine {

class LatticeEquations {
 public:
  // Normal equations of the sum that LatticeFit minimises.
  LatticeEquations(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
                   std::span<const float> stiffness, const std::vector<bool>& own,
                   std::span<const std::uint32_t> fixed);

  // The same for equations that differ from `earlier` only in the stiffness of some nodes: rows
  // that these do not enter are taken from there. `changed` becomes the rows that are new. Same
  // bits as the constructor above.
  LatticeEquations(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
                   std::span<const float> stiffness, const std::vector<bool>& own,
                   std::span<const std::uint32_t> fixed, const LatticeEquations& earlier,
                   std::vector<bool>& changed);

  // A fixed node is coupled with itself only.
  const SparseRows<double>& rows() const { return rows_; }

 private:
  // Second differences and trilinear samples couple a node with the 27 about it and with those two
  // steps along an axis.
  static constexpr std::size_t kSlots = 33;
  struct Place {
    int x, y, z;
  };
  Place placeOf(std::uint32_t number) const;
  std::vector<bool> about(const std::vector<bool>& some) const;
  void addAll(std::span<const LatticeSample> samples, std::span<const float> stiffness,
              const std::vector<bool>& own);
  void addSamples(std::span<const LatticeSample> samples);
  void addLaplacians(std::span<const float> stiffness, const std::vector<bool>& own);
  void addBending(std::span<const float> stiffness);
  void compress(std::span<const std::uint32_t> fixed, const LatticeEquations* earlier);

  const ActiveNodes& nodes_;
  // While the rows are made: which are wanted, and the nodes whose terms enter them. Slots of other
  // rows are incomplete.
  std::vector<bool> wanted_, entering_;
  std::vector<std::array<double, kSlots>> slots_;  // by node
  SparseRows<double> rows_;
};

}  // namespace echocine
