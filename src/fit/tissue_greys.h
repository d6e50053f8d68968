#pragma once
// Grey level of each tissue and gain over depth, estimated jointly from a loop (Eq. 3 of
// fit_terms.h).

#include <algorithm>
#include <vector>

#include "core/lanes.h"

namespace echocine::fit {

inline constexpr int kGainKnots = 4;  // knots of the piecewise linear gain; our choice

// Weighted least squares of g = grey(tissue) + gain(depth), accumulated cell by cell.
class TissueGreys {
 public:
  explicit TissueGreys(const std::vector<bool>& blood);

  // A cell of grey level g with a share `share` of tissue `first`, the rest of `second`. depth: 0
  // to 1. `expected`: a part of g that the model knows beyond its tissues. The total sum of squares
  // includes it.
  void add(int first, int second, double share, double depth, double g, double weight,
           double expected = 0) {
    const double place = depth * (kGainKnots - 1);
    const int knot = place >= kGainKnots - 1 ? kGainKnots - 2
                     : place < 0             ? 0
                                             : static_cast<int>(place);
    const double high = place - knot, rest = g - expected;
    if (expected != 0) {
      double* all = expected_.data() + knot * kDoubleLanes;
      store(lanesAt(all) + weight * Doubles4{expected, high * expected, expected * (g + rest), 0},
            all);
    }
    if (first == second || share >= 1) {
      double* m = moments_.data() + (first * (kGainKnots - 1) + knot) * kMoments;
      store(lanesAt(m) + weight * Doubles4{1, high, high * high, rest}, m);
      store(lanesAt(m + kDoubleLanes) + weight * Doubles4{high * rest, rest * rest, 0, 0},
            m + kDoubleLanes);
    } else {
      addMixed(first, second, share, knot, high, rest, weight);
    }
  }

  struct Fit {
    bool solved = false;             // false: the normal equations have no solution
    double residual = 0, total = 0;  // sums of squares
    std::vector<double> grey;        // by tissue; NaN for an invisible tissue
    double gain[kGainKnots] = {};    // by knot, with mean 0
    // The residual of a cell of grey level g, as in add(); NaN if a tissue of it is invisible.
    double left(int first, int second, double share, double depth, double g) const;
    // 0 to 1; 1, the worst, without a solution.
    double ratio() const { return solved && total > 0 ? std::min(1.0, residual / total) : 1; }
  };
  Fit fit() const;

 private:
  // Pairs of unknowns, stored once: the sum of an unordered pair is that of both places.
  struct Sums {
    std::vector<double> normal, right;
    double weight = 0, square = 0;

    // Adds `parts` unknowns of these values.
    void add(const int* at, const double* value, int parts, int unknowns, double g, double weight);
  };
  void addMixed(int first, int second, double share, int knot, double high, double g,
                double weight);
  Sums all() const;
  Sums withExpected(Sums sums) const;
  Fit solve(const Sums& sums, const std::vector<int>& group_of) const;

  std::vector<bool> blood_;
  int tissues_, unknowns_;
  // For cells of one tissue, by tissue and knot: sums of 1, h, h^2, g, h g, g^2, where h is the
  // place between the knot and the next.
  static constexpr std::size_t kMoments = 2 * kDoubleLanes;
  std::vector<double> moments_;
  Sums mixed_;  // of cells of two tissues
  // Sums of g, h g and g^2 over all cells that expected parts add, by knot.
  std::vector<double> expected_;
};

}  // namespace echocine::fit
