#pragma once
// The quadratic function of place that is nearest to samples, for many columns of values at once.

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "motion/interior/lattice_fit.h"

namespace echocine {

// u_c(x) = sum_k factors_c[k] f_k(s), with s = (x - middle) / size and the functions f: 1, the
// three coordinates and their six products.
struct QuadraticFit {
  static constexpr std::size_t kTerms = 10;
  using Terms = std::array<double, kTerms>;

  Vec3d middle;                // weighted mean of the points, m
  double size_m = 1;           // root mean square of the coordinates about it
  std::vector<Terms> factors;  // by column, in the values' unit

  Terms termsAt(Vec3d place_m) const;
};

// Least squares by the samples' weights plus kProductRidge of the products' factors: surfaces near
// a quadric leave one product open. values: columns per point; a sample per point, one at least.
QuadraticFit quadraticFit(std::span<const Vec3f> points_m, std::span<const LatticeSample> samples,
                          std::span<const float> values, std::size_t columns);

// Fits as quadraticFit(), and takes the function from the values as its values at the nodes give it
// there. Returns those: columns values per node.
std::vector<float> takeQuadratic(std::span<const Vec3f> points_m,
                                 std::span<const LatticeSample> samples,
                                 std::span<const Vec3d> node_places_m, std::size_t columns,
                                 std::span<float> values);

}  // namespace echocine
