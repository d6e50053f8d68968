#include "speckle/tap_table.h"

#include <algorithm>
#include <cmath>

#include "speckle/point_spread.h"

namespace echocine {

namespace {

constexpr double kCutDeviations = 2.5;
// Narrower bells are widened to this: a sample stands for its interval where cells are narrower.
// Our choice.
constexpr double kLeastDeviation = 0.3;

}  // namespace

TapTable::TapTable(double deviation, int lanes) {
  const double sigma = std::max(deviation, kLeastDeviation);
  const int wanted = static_cast<int>(std::ceil(2 * kCutDeviations * sigma));
  taps_ = lanes > 1 ? (wanted + lanes - 1) / lanes * lanes : wanted | 1;
  for (int step = 0; step < kTapSteps; ++step) {
    const double x = (step + 0.5) / kTapSteps - 0.5;
    for (int t = 0; t < taps_; ++t)
      values_.push_back(static_cast<float>(bell(first(step) + t - x, sigma)));
  }
}

}  // namespace echocine
