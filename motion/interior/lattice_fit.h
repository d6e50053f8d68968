#pragma once
// Many scalar fields on the nodes of one lattice, each the smoothest that meets its data.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/vec3.h"

namespace echocine {

// Nodes of a box of a lattice that take part, row by row along x, slab by slab along y.
struct ActiveNodes {
  int nx = 0, ny = 0, nz = 0;
  std::vector<std::int32_t> number;  // by node of the box; -1: takes no part
  std::vector<std::uint32_t> nodes;  // of the box, ascending

  std::size_t at(int ix, int iy, int iz) const {
    return (static_cast<std::size_t>(iy) * static_cast<std::size_t>(nz) +
            static_cast<std::size_t>(iz)) *
               static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(ix);
  }
  // -1 outside the box.
  std::int32_t numberAt(int ix, int iy, int iz) const {
    const bool within = ix >= 0 && iy >= 0 && iz >= 0 && ix < nx && iy < ny && iz < nz;
    return within ? number[at(ix, iy, iz)] : -1;
  }
};

// A place with the corners of its cell.
struct LatticeSample {
  std::uint32_t node[8];  // numbers of active nodes; bit 0 counts along x, 1 along z, 2 along y
  float share[8];         // trilinear
  float weight = 1;
};

class LatticeEquations;
class Multigrid;

// Minimises for each of many fields u separately
//   sum_j weight_j (N_j u - data_j)^2 + sum_i stiffness_i (L o_i (Lap u)_i^2 + B |D^2 u|_i^2)
// over the active nodes i, in units of the lattice. o_i is 1 at the body's own nodes and 0
// elsewhere. L and B are the constants of lattice_equations.cpp.
class LatticeFit {
 public:
  struct Solution {
    std::vector<float> values;  // columns values per active node
    double residual = 0;  // what the solver left, in parts of the right side: the worst column
  };

  // Keeps references to nodes, samples and own. Fixed nodes keep 0.
  LatticeFit(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
             std::span<const float> stiffness, const std::vector<bool>& own,
             std::span<const std::uint32_t> fixed);
  ~LatticeFit();

  // Makes the equations anew, of the samples' weights as they are now. If only the stiffness of
  // some nodes differs, only what depends on it is computed; the bits are the same.
  void update(std::span<const float> stiffness);

  // From `start` (columns values per active node, or none: 0) until the equations' residual is
  // `tolerance` of their right side, as root mean squares, for each column. data: columns values
  // per sample.
  Solution solve(std::span<const float> data, std::size_t columns, std::vector<float> start,
                 double tolerance) const;

 private:
  const ActiveNodes& nodes_;
  std::span<const LatticeSample> samples_;
  const std::vector<bool>& own_;
  std::vector<std::uint32_t> fixed_;
  std::vector<float> stiffness_, weights_;  // of the equations as they are
  std::unique_ptr<const LatticeEquations> equations_;
  std::unique_ptr<const Multigrid> grid_;
};

}  // namespace echocine
