#pragma once
// The inverse curvature of a function, corrected by its slopes at successive places.

#include <vector>

namespace echocine::fit {

// (25)  C' = (I - s y^T / s y) C (I - y s^T / s y) + s s^T / s y
// with the step s between two places and the change y of the slopes: the BFGS update (Nocedal and
// Wright, Numerical Optimization, 2006, Eq. 6.17), so that C' y = s. C stays symmetric and positive
// definite. The slopes are noisy. Therefore steps shorter than kShortest standard deviations of the
// first covariance C_0 change nothing, and y is moved towards C_0^-1 s (Powell's damping) or
// shortened until the curvature along s is kLeastRatio to kMostRatio times the first one. The three
// are our choice.
class SecantCovariance {
 public:
  static constexpr double kShortest = 0.5, kLeastRatio = 0.5, kMostRatio = 4;

  // Precondition: row by row, symmetric and positive definite.
  explicit SecantCovariance(std::vector<double> first) : first_(first), covariance_(first) {}

  // The next place and its slopes. Precondition: as many values as the covariance has rows.
  void add(const std::vector<double>& at, const std::vector<double>& slopes);

  const std::vector<double>& covariance() const { return covariance_; }

 private:
  std::vector<double> first_, covariance_;
  std::vector<double> at_, slopes_;  // of the last place; empty before the first
};

}  // namespace echocine::fit
