#pragma once
// A smooth curve through given points without overshoot.

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/check.h"

namespace echocine {

// Piecewise cubic through knots, once differentiable, and monotone wherever the knots are. Slopes
// after Fritsch and Butland, "A method for constructing local monotone piecewise cubic
// interpolants", SIAM J. Sci. Stat. Comput. 5(2), 300-304, 1984. Constant outside the knots.
class MonotoneCubic {
 public:
  // Precondition: at least two knots (x, y), x strictly ascending.
  explicit MonotoneCubic(std::vector<std::pair<double, double>> knots) : knots_(std::move(knots)) {
    CHECK_LE(std::size_t{2}, knots_.size());
    const std::size_t last = knots_.size() - 1;
    slopes_.assign(knots_.size(), 0);
    for (std::size_t i = 1; i < last; ++i) {
      const double left = secant(i - 1), right = secant(i);
      if (left * right <= 0) continue;  // an extremum of the knots is an extremum of the curve
      const double h_left = gap(i - 1), h_right = gap(i);
      const double a = (h_left + 2 * h_right) / (3 * (h_left + h_right));
      slopes_[i] = left * right / (a * right + (1 - a) * left);
    }
    slopes_[0] = endSlope(secant(0), last > 1 ? slopes_[1] : secant(0));
    slopes_[last] = endSlope(secant(last - 1), last > 1 ? slopes_[last - 1] : secant(0));
  }

  double operator()(double x) const {
    if (!(x > knots_.front().first)) return knots_.front().second;
    if (!(x < knots_.back().first)) return knots_.back().second;
    const auto above =
        std::upper_bound(knots_.begin(), knots_.end(), x,
                         [](double value, const auto& knot) { return value < knot.first; });
    const auto i = static_cast<std::size_t>(above - knots_.begin()) - 1;
    const double h = gap(i), t = (x - knots_[i].first) / h, s = 1 - t;
    return s * s * ((1 + 2 * t) * knots_[i].second + t * h * slopes_[i]) +
           t * t * ((1 + 2 * s) * knots_[i + 1].second - s * h * slopes_[i + 1]);
  }

 private:
  double gap(std::size_t i) const { return knots_[i + 1].first - knots_[i].first; }
  double secant(std::size_t i) const { return (knots_[i + 1].second - knots_[i].second) / gap(i); }
  // End slope of the parabola, limited by the bound for monotone cubics (three times the secant).
  static double endSlope(double secant, double inner) {
    const double slope = 1.5 * secant - 0.5 * inner;
    if (slope * secant <= 0) return 0;
    return std::abs(slope) > 3 * std::abs(secant) ? 3 * secant : slope;
  }

  std::vector<std::pair<double, double>> knots_;
  std::vector<double> slopes_;
};

}  // namespace echocine
