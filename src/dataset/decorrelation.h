#pragma once
// How long the grain of a piece of muscle stays like itself: the correlation of a block of the
// picture with itself, along the true track of the material point in its centre.

#include <vector>

#include "dataset/dataset_loop.h"

namespace echocine::dataset {

// A square of (2 kBlockHalf + 1)^2 samples at kBlockStep_m: 4 x 4 mm, which fits into a healthy
// wall of 9 mm around a point in its middle (our choice).
inline constexpr int kBlockHalf = 4;
inline constexpr double kBlockStep_m = 0.5e-3;

// Normalised correlation rho of two blocks a and b of equal size, in [-1, 1] (Eq. 1):
//   rho = sum (a - mean a)(b - mean b) / sqrt(sum (a - mean a)^2 sum (b - mean b)^2).
// 0 if one of them is constant.
double correlationOf(const std::vector<float>& a, const std::vector<float>& b);

struct Decorrelation {
  int blocks = 0;  // material points that were followed; the curves are empty without any
  // By lag, from 0: rho between all pairs of frames of this lag in which both blocks are shown,
  // averaged over pairs and points; and the mean distance of the points from the imaging plane in
  // the later frame.
  std::vector<double> lag_ms, correlation, out_of_plane_mm;
};

// Follows tracked points in the middle of the wall, at most kMostBlocks. A block follows its point
// and is not turned or deformed, so rotation and strain decorrelate too, as for a block matcher.
// Greys are interpolated linearly between pixel centres. Points out of the picture are left out
// while they are there. Lags reach up to half the loop.
Decorrelation decorrelationOf(const LoopSample& loop);

inline constexpr int kMostBlocks = 40;  // our choice

}  // namespace echocine::dataset
