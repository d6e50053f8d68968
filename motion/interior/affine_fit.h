#pragma once
// The affine function of place that is nearest to samples, for many columns of values at once.

#include <cstddef>
#include <span>
#include <vector>

#include "motion/interior/lattice_fit.h"

namespace echocine {

// u_c(x) = mean_c + slope_c . (x - middle); u in the values' unit, x and middle in metres.
struct AffineFit {
  Vec3d middle;              // weighted mean of the points
  std::vector<double> mean;  // by column
  std::vector<Vec3d> slope;  // by column, per metre

  double at(std::size_t column, Vec3d place_m) const {
    return mean[column] + dot(slope[column], place_m - middle);
  }
};

// Least squares by the samples' weights. values: columns per point; a sample per point, one at
// least. Slopes that flat or few points leave open are 0.
AffineFit affineFit(std::span<const Vec3f> points_m, std::span<const LatticeSample> samples,
                    std::span<const float> values, std::size_t columns);

}  // namespace echocine
