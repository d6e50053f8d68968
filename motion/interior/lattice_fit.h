#pragma once
// Many scalar fields on the nodes of one lattice, each the smoothest that meets its data.

#include <cstdint>
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

// Minimises for each of `columns` fields u separately
//   sum_j weight_j (N_j u - data_j)^2 + sum_i stiffness_i |D^2 u|_i^2,   D^2 in units of the
//   lattice,
// by at most `steps` of conjugate gradients on all of them together, from `start` (columns values
// per active node, or none: 0). data: columns values per sample; fixed nodes keep 0. Returns
// columns values per active node.
std::vector<float> fitLattice(const ActiveNodes& nodes, std::span<const LatticeSample> samples,
                              std::span<const float> data, std::size_t columns,
                              std::span<const float> stiffness,
                              std::span<const std::uint32_t> fixed, std::vector<float> start,
                              int steps);

}  // namespace echocine
