#pragma once
// Edges of a frame at the scale of walls.

#include <span>
#include <vector>

#include "echo/beam_grid.h"

namespace echocine::compare {

// Standard deviation of the smoothing as a share of the depth: 3 mm in 15 cm. Our choice: above
// speckle, which the paper's model lacks, and below the thickness of a wall.
inline constexpr double kSmoothingShare = 0.02;

// Gradient of a smoothed frame u on a lattice of beam space, grey levels per hundredth of the
// depth: along = du/dr, across = du/(r dtheta). Edges of all directions thus have equal weight.
struct EdgeField {
  std::vector<float> along, across, weight;  // weight 0: a neighbour lies outside the area
};

// Central differences of `smooth` (line-major on the lattice), with the smallest weight of a place
// and its neighbours each way. `depth`: the full depth, for the unit.
EdgeField edgesOf(const echo::BeamGrid& lattice, std::span<const float> smooth,
                  std::span<const float> weights, double depth);

// (1)  G = sum w g_x . g_y / sqrt(sum w |g_x|^2 sum w |g_y|^2)
// over samples with weight in both frames, -1..1: the gradient correlation of Penney et al. (IEEE
// Trans. Med. Imaging 17(4), 1998), with both directions under one root. It is invariant to
// brightness and contrast, and nearly so to slowly varying gain. 0 if one frame has no edges, 1 if
// neither has.
double edgeCorrelation(const EdgeField& x, const EdgeField& y);

// Frames of one area as edge fields: means over blocks of half the smoothing's standard deviation,
// Gaussian smoothing within the area, gradient of Eq. 1. Lateral smoothing has its nominal length
// at half the depth and widens in proportion, like beams.
class WallEdges {
 public:
  WallEdges(const echo::BeamGrid& grid, std::span<const float> weights);

  const echo::BeamGrid& lattice() const { return lattice_; }  // of the block centres
  double depth() const { return depth_; }
  EdgeField operator()(std::span<const float> frame) const;

 private:
  void smooth(std::vector<float>& values) const;

  echo::BeamGrid grid_, lattice_;
  double depth_ = 1;
  int line_block_ = 1, sample_block_ = 1, first_line_ = 0, first_sample_ = 0;
  double along_ = 1, across_ = 1;             // standard deviations in blocks
  std::vector<float> weights_;                // of the samples
  std::vector<float> block_weights_, share_;  // of a block; share of its window inside the area
};

}  // namespace echocine::compare
