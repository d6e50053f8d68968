#pragma once
// A quadratic function of several unknowns: its minimum in a box and its inverse curvature.

#include <cstddef>
#include <vector>

namespace echocine::fit {

// value + g u + u H u / 2.
struct Quadratic {
  explicit Quadratic(std::size_t unknowns)
      : gradient(unknowns, 0), hessian(unknowns * unknowns, 0) {}
  double value = 0;
  std::vector<double> gradient, hessian;  // row by row

  std::size_t size() const { return gradient.size(); }
  double& bend(std::size_t i, std::size_t j) { return hessian[i * size() + j]; }
  double at(const std::vector<double>& u) const;
};

// The same with curvatures of at least `least` in all directions: those below it, negative ones
// too, become it. Differences of a noisy function may have no minimum.
Quadratic convex(const Quadratic& q, double least);

// The minimum within low and high, by descent along one unknown at a time. Precondition: convex.
std::vector<double> minimumWithin(const Quadratic& q, const std::vector<double>& low,
                                  const std::vector<double>& high);

// Inverse of the curvature: the covariance if the function is minus a log density. Precondition:
// convex.
std::vector<double> covarianceOf(const Quadratic& q);

}  // namespace echocine::fit
