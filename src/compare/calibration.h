#pragma once
// Grey calibration: a continuous piecewise linear curve from synthetic to real grey.

#include <cstddef>
#include <span>
#include <vector>

namespace echocine::compare {

struct GreyCurve {
  std::vector<double> knots, values;  // synthetic grey, ascending, and the real grey it stands for

  double operator()(double grey) const;  // constant beyond the ends; no knots: grey as it is
  void apply(std::span<const float> in, std::span<float> out) const;
};

// Weighted least squares over all samples that are added: values v of the hat functions on the
// knots that minimise sum w (real - sum_k v_k hat_k(synthetic))^2. With `monotone` the least among
// curves that never fall: v_k = v_0 + d_1 + ... + d_k with every d >= 0, solved by active sets.
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

// `count` knots at even shares of the weighted greys; equal ones fall together (a grey that fills
// much of the picture), at least two remain.
std::vector<double> quantileKnots(std::span<const std::vector<float>* const> frames,
                                  std::span<const float> weights, int count);

}  // namespace echocine::compare
