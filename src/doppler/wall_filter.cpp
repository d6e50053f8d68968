#include "doppler/wall_filter.h"

#include <cmath>
#include <cstddef>

#include "core/check.h"

namespace echocine {

namespace {

double product(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t n = 0; n < a.size(); ++n) sum += a[n] * b[n];
  return sum;
}

void subtract(const std::vector<double>& base, double share, std::vector<double>& from) {
  for (std::size_t n = 0; n < from.size(); ++n) from[n] -= share * base[n];
}

}  // namespace

WallFilter::WallFilter(WallFilterKind kind, int pulses) {
  CHECK_LE(leastPulses(kind), pulses);
  for (int order = 0; order < static_cast<int>(kind); ++order) {
    std::vector<double> power;
    for (int n = 0; n < pulses; ++n) power.push_back(std::pow(n - 0.5 * (pulses - 1), order));
    for (const std::vector<double>& lower : polynomials_)
      subtract(lower, product(lower, power), power);
    const double size = std::sqrt(product(power, power));
    for (double& value : power) value /= size;
    polynomials_.push_back(std::move(power));
  }
}

void WallFilter::apply(std::vector<double>& packet) const {
  for (const std::vector<double>& base : polynomials_)
    subtract(base, product(base, packet), packet);
}

}  // namespace echocine
