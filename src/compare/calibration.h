#pragma once
// Grey calibration: a continuous piecewise linear curve from synthetic to real grey.

#include <cstddef>
#include <span>
#include <vector>

namespace echocine::compare {

struct GreyCurve {
  std::vector<double> knots, values;  // synthetic grey level, ascending, and its real grey level

  double operator()(double grey) const;  // constant beyond the ends; identity without knots
  void apply(std::span<const float> in, std::span<float> out) const;
};

// Weighted least squares over all added samples: values v of the hat functions on the knots that
// minimise sum w (real - sum_k v_k hat_k(synthetic))^2. With `monotone` the minimum among
// non-decreasing curves: v_k = v_0 + d_1 + ... + d_k with every d >= 0, solved by active sets.
class CalibrationFit {
 public:
  explicit CalibrationFit(std::vector<double> knots);  // two or more, strictly ascending

  void add(std::span<const float> synthetic, std::span<const float> real,
           std::span<const float> weights);
  GreyCurve solve(bool monotone) const;

 private:
  std::vector<double> knots_;
  std::vector<double> normal_, right_;  // K x K and K
};

// `count` knots at quantiles of the weighted grey levels. Equal knots, from a grey level that fills
// much of the picture, are merged; at least two remain.
std::vector<double> quantileKnots(std::span<const std::vector<float>* const> frames,
                                  std::span<const float> weights, int count);

}  // namespace echocine::compare
