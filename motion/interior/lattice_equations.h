#pragma once
// The normal equations of a lattice's fit: a sparse row per active node.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "motion/interior/lattice_fit.h"

namespace echocine {

class LatticeEquations {
 public:
  // Of the sum that fitLattice() minimises.
  LatticeEquations(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
                   std::span<const float> stiffness, std::span<const std::uint32_t> fixed);

  // The nodes that a node is coupled with, and how strongly: A x at n is sum values[i]
  // x[members[i]].
  struct Row {
    std::span<const std::uint32_t> members;
    std::span<const float> values;
  };
  std::size_t size() const { return starts_.size() - 1; }
  Row operator[](std::size_t n) const {
    const std::size_t first = starts_[n], count = starts_[n + 1] - first;
    return {{&members_[first], count}, {&values_[first], count}};
  }
  // One over the diagonal, by node.
  const std::vector<float>& inverseDiagonal() const { return inverse_diagonal_; }

 private:
  // Second differences and trilinear samples couple a node with the 27 about it and with those two
  // steps along an axis.
  static constexpr std::size_t kSlots = 33;
  struct Place {
    int x, y, z;
  };
  Place placeOf(std::uint32_t number) const;
  void addSamples(std::span<const LatticeSample> samples);
  void addBending(std::span<const float> stiffness);
  void compress(std::span<const std::uint32_t> fixed);

  const ActiveNodes& nodes_;
  std::vector<std::array<double, kSlots>> slots_;  // by node; empty when the rows are made
  std::vector<std::uint32_t> starts_, members_;
  std::vector<float> values_, inverse_diagonal_;
};

}  // namespace echocine
