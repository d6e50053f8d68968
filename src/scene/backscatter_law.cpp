#include "scene/backscatter_law.h"

#include <cmath>
#include <numbers>

namespace echocine {

double particleBackscatter(double k, double a, double G_e, double G, double rho_e, double rho) {
  constexpr double kCosTheta = -1;  // theta = 180 degrees: straight back
  const double contrast = (G_e - G) / G + 3 * (rho_e - rho) / (2 * rho_e + rho) * kCosTheta;
  const double k2 = k * k;
  const double a3 = a * a * a;
  return k2 * k2 * a3 * a3 / 9 * contrast * contrast;
}

double bloodBackscatter(double sigma_b, double W_0, double V) {
  const double free = (1 - W_0) * (1 - W_0);
  const double crowding = 1 + 2 * W_0;
  return sigma_b / V * W_0 * free * free / (crowding * crowding);
}

double tissueBackscatter(double mu, double k, double b_m) {
  constexpr double kSeriesBelow = 0.05;  // there the closed form has lost two of its sixteen digits
  const double x = k * b_m;
  const double x2 = x * x;
  double bracket = 0;
  if (x < kSeriesBelow) {
    // sum over j >= 1 of (-1)^(j+1) 2j/(2j+1) (1 + 9^j/3) x^(2j+1), from the series of the
    // arctangents and of the fractions; ten terms leave (3x)^22 < 1e-17.
    double power = x;
    double nine_to_j = 1;
    for (int j = 1; j <= 10; ++j) {
      power *= -x2;
      nine_to_j *= 9;
      bracket -= power * (2.0 * j / (2.0 * j + 1)) * (1 + nine_to_j / 3);
    }
  } else {
    bracket = std::atan(x) + std::atan(3 * x) / 9 - x / (1 + x2) - x / (3 * (1 + 9 * x2));
  }
  return 3 * mu * mu * k / (4 * std::numbers::pi) * bracket;
}

}  // namespace echocine
