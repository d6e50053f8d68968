#pragma once
// Sums along a row of the grid: from its nodes to the line's samples.

#include <vector>

#include "core/lanes.h"
#include "speckle/splat_grid.h"

namespace echocine {

class AxialSums {
 public:
  AxialSums(const SplatGrid& grid, int samples);

  // From the nodes of a row, with the grid's margin of zeros about them, to its samples: four
  // floats each, as those of a node. `out` takes whole eights of samples.
  void smear(const float* nodes, int samples, float* out) const;

 private:
  static constexpr int kPairs = 4;
  // Samples with the same taps, if the width changes along a line: it changes by under 0.5 % from
  // piece to piece of a sector 16 cm deep with 1024 samples.
  static constexpr int kPiece = 32;
  void addTaps(double deviation);  // in nodes
  template <typename Load>
  void smearBy(const float* nodes, int samples, const Load& load, float* out) const;

  int finer_, coarser_;
  TapRange range_;
  int pieces_ = 1;
  // By piece, and pair of samples between two nodes: k, k, H, H of the first and of the second
  // sample.
  std::vector<Floats8> taps_;
};

}  // namespace echocine
