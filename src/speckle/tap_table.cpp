#include "speckle/tap_table.h"

#include <algorithm>
#include <cmath>

#include "speckle/point_spread.h"

namespace echocine {

namespace {

// Bells end at 0 there, less what they would have: a step would come and go as places move. They
// are wider by this, so that speckle's autocorrelation is as wide as that of whole bells.
constexpr double kWider = 1 / 0.936;
// Narrower bells are widened to this: a sample stands for its interval where cells are narrower.
// Our choice.
constexpr double kLeastSamples = 0.3;

}  // namespace

TapTable::TapTable(double deviation, int lanes) {
  const double sigma = kWider * std::max(deviation, kLeastSamples);
  const double end = bell(kCutDeviations, 1);
  const int wanted = static_cast<int>(std::ceil(2 * kCutDeviations * sigma));
  taps_ = lanes > 1 ? (wanted + lanes - 1) / lanes * lanes : wanted | 1;
  for (int step = 0; step < kTapSteps; ++step) {
    const double x = (step + 0.5) / kTapSteps - 0.5;
    for (int t = 0; t < taps_; ++t)
      values_.push_back(
          static_cast<float>(std::max(bell(first(step) + t - x, sigma) - end, 0.0) / (1 - end)));
  }
}

}  // namespace echocine
