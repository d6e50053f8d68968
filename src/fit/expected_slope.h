#pragma once
// How the discrepancy of a model changes at the model's own dials in its own rendered loops.

#include <vector>

namespace echocine::fit {

// Differences of D for Eq. 24, and of J for steps with it, in steps of an unknown. Our choice.
inline constexpr double kSlopeStep = 0.5;

// D is not lowest at the true heart: its terms are ratios, and a larger or faster heart also has
// larger denominators. The slope of D at a heart's dials in the heart's own loops is this bias.
//
// (24)  D'(x) = D(x) - q c s (x - x_0)
// x: unknowns of a view; x_0: those of the heart whose look is expected; s: slope of D at x_0, mean
// over own loops; q, c: of Eqs. 20 and 21, because s does not apply to a loop that looks different.
// Limit: s is a straight line, so x stays near x_0.
class ExpectedSlope {
 public:
  // None: D' is D.
  ExpectedSlope() = default;
  // One slope of D for each unknown. q c is 1.
  ExpectedSlope(std::vector<double> at, std::vector<double> slopes);

  // Sets q c.
  void scaleTo(double shown) { shown_ = shown; }

  // q c s (x - x_0); 0 without slopes. `at` has the unknowns of the view in the same order.
  double of(const std::vector<double>& at) const;

 private:
  std::vector<double> at_, slopes_;
  double shown_ = 1;
};

}  // namespace echocine::fit
