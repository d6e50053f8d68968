#include "trace/layer_series.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echocine {

namespace {

constexpr double kMostReturned = 0.7;  // |q|: under 80 terms
constexpr double kLeastTerm = 1e-7;    // of the first one

// Sums over d > 0 of (-q)^(d-1) (1 - C(d x)), and of d times that.
struct LagSums {
  double plain = 0, by_lag = 0;
};

LagSums lagSums(double q, double x, double N) {
  const double X = 2 * std::numbers::pi * N;
  const double sin_step = std::sin(x / 2), cos_step = std::cos(x / 2);
  double s = sin_step, c = cos_step;  // of y / 2
  double power = 1;                   // (-q)^(d-1)
  LagSums sums;
  for (int d = 1; std::abs(power) * d * d > kLeastTerm; ++d, power *= -q) {
    const double y = d * x;
    if (y >= X) {  // C is 0 from here on
      sums.plain += power / (1 + q);
      sums.by_lag += power * (d / (1 + q) - q / ((1 + q) * (1 + q)));
      break;
    }
    const double unlike = 2 * s * s + (y * (1 - 2 * s * s) - 2 * s * c) / X;  // 1 - C(y)
    sums.plain += power * unlike;
    sums.by_lag += power * d * unlike;
    const double turned = s * cos_step + c * sin_step;
    c = c * cos_step - s * sin_step;
    s = turned;
  }
  return sums;
}

}  // namespace

std::optional<StackResponse> layerSeries(const LayerFaces& faces, double N) {
  const bool plain =
      faces.layers == 1 && faces.phase[0].re == 0 && faces.r[0].im == 0 && faces.r[1].im == 0;
  if (!plain) return std::nullopt;
  const double r_1 = faces.r[0].re, r_2 = faces.r[1].re, q = faces.kept[0] * r_1 * r_2;
  if (std::abs(q) > kMostReturned) return std::nullopt;
  const LagSums sums = lagSums(q, 2 * faces.phase[0].im, N);
  const double second = (1 - r_1 * r_1) * r_2, Q = q * q, less = 1 - Q, more = 1 + q;
  const double A = r_1 * second - q * second * second / less;
  const double first = r_1 + second / more;
  const double reflected = first * first - 2 * A * sums.plain;
  const double lags = -q / (less * less) * ((1 + Q) / less * sums.plain + sums.by_lag);
  const double once = faces.flux * (1 + r_1) * (1 + r_1) * (1 + r_2) * (1 + r_2);
  const double passed = once * once * (1 / (more * more * more * more) - 2 * lags);
  return StackResponse{std::max(reflected, 0.0), std::max(passed, 0.0)};
}

}  // namespace echocine
