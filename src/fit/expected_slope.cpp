#include "fit/expected_slope.h"

#include "core/check.h"

namespace echocine::fit {

ExpectedSlope::ExpectedSlope(std::vector<double> at, std::vector<double> slopes)
    : at_(std::move(at)), slopes_(std::move(slopes)) {
  CHECK_EQ(at_.size(), slopes_.size());
}

double ExpectedSlope::of(const std::vector<double>& at) const {
  if (slopes_.empty()) return 0;
  CHECK_EQ(at.size(), at_.size());
  double sum = 0;
  for (std::size_t i = 0; i < at.size(); ++i) sum += slopes_[i] * (at[i] - at_[i]);
  return shown_ * sum;
}

}  // namespace echocine::fit
