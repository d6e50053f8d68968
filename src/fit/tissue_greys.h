#pragma once
// Grey level of each tissue and gain over depth, estimated jointly from a loop (Eq. 3 of
// fit_terms.h).

#include <algorithm>
#include <vector>

namespace echocine::fit {

inline constexpr int kGainKnots = 4;  // knots of the piecewise linear gain; our choice

// Weighted least squares of g = grey(tissue) + gain(depth), accumulated cell by cell.
class TissueGreys {
 public:
  explicit TissueGreys(const std::vector<bool>& blood);

  // A cell of grey level g with a share `share` of tissue `first`, the rest of `second`. depth: 0
  // to 1.
  void add(int first, int second, double share, double depth, double g, double weight) {
    const double place = depth * (kGainKnots - 1);
    const int knot = place >= kGainKnots - 1 ? kGainKnots - 2
                     : place < 0             ? 0
                                             : static_cast<int>(place);
    const double high = place - knot;
    // Cells of one tissue have no second: it comes last, and is skipped.
    const int at[4] = {tissues_ + knot, tissues_ + knot + 1, first, second};
    const bool whole = first == second || share >= 1;
    const double value[4] = {1 - high, high, whole ? 1 : share, 1 - share};
    const int parts = whole ? 3 : 4;
    for (int a = 0; a < parts; ++a) {
      const double wa = weight * value[a];
      double* row = normal_.data() + at[a] * unknowns_;
      for (int b = 0; b <= a; ++b) row[at[b]] += wa * value[b];
      right_[static_cast<std::size_t>(at[a])] += wa * g;
    }
    weight_ += weight;
    square_ += weight * g * g;
  }
  double weight() const { return weight_; }

  struct Fit {
    bool solved = false;             // false: the normal equations have no solution
    double residual = 0, total = 0;  // sums of squares
    std::vector<double> grey;        // by tissue; NaN for an invisible tissue
    double gain[kGainKnots] = {};    // by knot, with mean 0
    // 0 to 1; 1, the worst, without a solution.
    double ratio() const { return solved && total > 0 ? std::min(1.0, residual / total) : 1; }
  };
  Fit fit() const;

 private:
  Fit solve(const std::vector<int>& group_of) const;

  std::vector<bool> blood_;
  int tissues_, unknowns_;
  // Pairs of unknowns, stored once: the sum of an unordered pair is that of both places.
  std::vector<double> normal_, right_;
  double weight_ = 0, square_ = 0;
};

}  // namespace echocine::fit
