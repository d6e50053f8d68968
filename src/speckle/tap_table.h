#pragma once
// A sampled bell whose middle lies between samples.

#include <cstddef>
#include <vector>

namespace echocine {

// Steps into which the interval about a sample is cut: a place errs by at most 1/128 of it.
inline constexpr int kTapSteps = 64;

// exp(-(n - x)^2 / 2 sigma^2) at whole n, x = (step + 1/2) / kTapSteps - 1/2 from the sample that
// is nearest. Taps beyond 2.5 sigma (4 % of the amplitude) are left out.
class TapTable {
 public:
  // lanes: the number of taps is a multiple of this, else it is odd.
  explicit TapTable(double deviation, int lanes = 1);

  int taps() const { return taps_; }
  // Of the first tap: n there.
  int first(int step) const { return 2 * step < kTapSteps ? -taps_ / 2 : (1 - taps_) / 2; }
  const float* row(int step) const {
    return values_.data() + static_cast<std::ptrdiff_t>(step) * taps_;
  }

 private:
  int taps_;
  std::vector<float> values_;
};

}  // namespace echocine
