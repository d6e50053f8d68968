#pragma once
// Weighted least-squares fit of an affine function of place, for many columns of values at once.

#include <cstddef>
#include <span>
#include <vector>

#include "motion/interior/lattice_fit.h"

namespace echocine {

// u_c(x) = mean_c + slope_c . (x - middle); u in the unit of the values, x and middle in metres.
struct AffineFit {
  Vec3d middle;              // weighted mean of the points
  std::vector<double> mean;  // by column
  std::vector<Vec3d> slope;  // by column, per metre

  double at(std::size_t column, Vec3d place_m) const {
    return mean[column] + dot(slope[column], place_m - middle);
  }
};

// values: columns per point; one sample per point, at least one. Slopes that are undetermined for
// flat or few points are 0.
AffineFit affineFit(std::span<const Vec3f> points_m, std::span<const LatticeSample> samples,
                    std::span<const float> values, std::size_t columns);

}  // namespace echocine
