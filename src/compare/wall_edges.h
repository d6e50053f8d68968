#pragma once
// Where edges run in a frame, at the scale of walls.

#include <span>
#include <vector>

#include "echo/beam_grid.h"

namespace echocine::compare {

// Standard deviation of the smoothing as a share of the depth: 3 mm in 15 cm. Our choice: above
// speckle, which the model leaves out, and below the thickness of a wall.
inline constexpr double kSmoothingShare = 0.02;

// Gradient of a smoothed frame u on a lattice of beam space, greys per hundredth of the depth:
// along = du/dr, across = du/(r dtheta), so edges of all directions count alike.
struct EdgeField {
  std::vector<float> along, across, weight;  // weight 0: a neighbour lies outside the area
};

// Central differences of `smooth` (line-major on the lattice), with the least weight of a place and
// its neighbours each way. `depth`: what a hundredth is of.
EdgeField edgesOf(const echo::BeamGrid& lattice, std::span<const float> smooth,
                  std::span<const float> weights, double depth);

// (1)  G = sum w g_x . g_y / sqrt(sum w |g_x|^2 sum w |g_y|^2)   over samples that weigh in both,
// -1..1: the gradient correlation of Penney et al. (IEEE Trans. Med. Imaging 17(4), 1998), with
// both directions under one root. Blind to brightness and contrast, and nearly so to gains that
// vary slowly over the picture. 0 when one frame has no edges, 1 when neither has.
double edgeCorrelation(const EdgeField& x, const EdgeField& y);

// Frames of one area as edge fields: means over blocks of half the smoothing's standard deviation,
// Gaussian smoothing within the area, Eq. 1's gradient. Lateral smoothing has its length at half
// the depth and widens in proportion, as beams do.
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
  std::vector<float> block_weights_, share_;  // of a block; how much of its window is in the area
};

}  // namespace echocine::compare
