#pragma once
// A quadratic function of several unknowns: its minimum in a box and its inverse curvature.

#include <cstddef>
#include <functional>
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
  // The same function of u - origin.
  Quadratic movedTo(const std::vector<double>& origin) const;
};

// A function's values at places, each given in steps of every unknown.
using ValuesAt = std::function<std::vector<double>(const std::vector<std::vector<double>>&)>;

// Central differences of a function of the listed unknowns, out of `all`, in units of a step. With
// `mixed`, its mixed derivatives are kept: 2 n + 1 values of n unknowns instead of
// (n^2 + 3 n + 2) / 2.
Quadratic differencesOf(std::size_t all, const std::vector<std::size_t>& of, const ValuesAt& values,
                        const Quadratic* mixed = nullptr);

// A function's value at a place, and its weight in a regression.
struct WeightedValue {
  std::vector<double> u;
  double value = 0, weight = 1;
};

// (22)  q = argmin sum_k w_k (f(u_k) - q(u_k))^2
// The quadratic of the listed unknowns, out of `all`, by weighted least squares: the solution of
// least norm, so coefficients that the values leave open are 0. It averages over noise and over
// deviations from a quadratic, where differencesOf() takes each value as exact.
Quadratic regressionOf(std::size_t all, const std::vector<std::size_t>& of,
                       const std::vector<WeightedValue>& values);

// The same with curvatures of at least `least` in all directions: those below it, negative ones
// too, become it. Differences of a noisy function may have no minimum.
Quadratic convex(const Quadratic& q, double least);

// (16)  H = H_prior + sum over views of H_view
// and the sum of values and gradients. Negative curvatures of a view, which are noise, become 0
// first. So no view makes the inverse of H larger in any direction. Precondition: the prior is
// convex.
Quadratic sumOfViews(const Quadratic& prior, const std::vector<Quadratic>& views);

// The minimum within low and high, by descent along one unknown at a time. Precondition: convex.
std::vector<double> minimumWithin(const Quadratic& q, const std::vector<double>& low,
                                  const std::vector<double>& high);

// Inverse of the curvature: the covariance if the function is minus a log density. Precondition:
// convex.
std::vector<double> covarianceOf(const Quadratic& q);

}  // namespace echocine::fit
