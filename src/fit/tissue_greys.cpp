#include "fit/tissue_greys.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>

namespace echocine::fit {

TissueGreys::TissueGreys(const std::vector<bool>& blood)
    : blood_(blood),
      tissues_(static_cast<int>(blood.size())),
      unknowns_(tissues_ + kGainKnots),
      normal_(static_cast<std::size_t>(unknowns_) * static_cast<std::size_t>(unknowns_), 0),
      right_(static_cast<std::size_t>(unknowns_), 0) {}

// Least squares with tissues that share a group sharing their grey. Gains add up to what greys do
// too: a ridge of 1e-9 of the weight decides between them and changes nothing that is seen.
TissueGreys::Fit TissueGreys::solve(const std::vector<int>& group_of) const {
  const int groups = *std::max_element(group_of.begin(), group_of.end()) + 1,
            n = groups + kGainKnots;
  cv::Mat a = cv::Mat::zeros(n, n, CV_64F), b = cv::Mat::zeros(n, 1, CV_64F), x;
  // Strips take weight from blood, so the sums of a wrong model may be of no least squares at all.
  Fit fit;
  fit.residual = std::numeric_limits<double>::infinity();
  fit.grey.assign(static_cast<std::size_t>(tissues_), std::numeric_limits<double>::quiet_NaN());
  const auto to = [&](int i) {
    return i < tissues_ ? group_of[static_cast<std::size_t>(i)] : i - tissues_ + groups;
  };
  for (int i = 0; i < unknowns_; ++i) {
    b.at<double>(to(i)) += right_[static_cast<std::size_t>(i)];
    for (int j = 0; j < unknowns_; ++j) {
      const auto at = [&](int row, int column) {
        return normal_[static_cast<std::size_t>(row * unknowns_ + column)];
      };
      a.at<double>(to(i), to(j)) += at(i, j) + (i == j ? 0 : at(j, i));
    }
  }
  cv::Mat ridged = a.clone();
  for (int i = 0; i < n; ++i) ridged.at<double>(i, i) += 1e-9 * weight_;
  if (!cv::solve(ridged, b, x, cv::DECOMP_CHOLESKY) || !cv::checkRange(x)) return fit;
  // From the sums themselves, not as reported by the solver. A value below 0 by more than rounding
  // is no least-squares residual.
  const double residual = square_ - 2 * x.dot(b) + x.dot(a * x);
  if (!(residual >= -1e-9 * std::abs(square_))) return fit;
  fit.solved = true;
  fit.residual = std::max(0.0, residual);
  double mean = 0;
  for (int k = 0; k < kGainKnots; ++k) mean += x.at<double>(groups + k) / kGainKnots;
  for (int k = 0; k < kGainKnots; ++k) fit.gain[k] = x.at<double>(groups + k) - mean;
  for (int t = 0; t < tissues_; ++t)
    if (normal_[static_cast<std::size_t>(t * unknowns_ + t)] > 1e-6 * weight_)
      fit.grey[static_cast<std::size_t>(t)] =
          x.at<double>(group_of[static_cast<std::size_t>(t)]) + mean;
  return fit;
}

// Tissues darker than blood are pooled with it, the darkest first, until none is: the least squares
// under that order (pooling of violators, Barlow et al. 1972).
TissueGreys::Fit TissueGreys::fit() const {
  const Fit one_grey = solve(std::vector<int>(static_cast<std::size_t>(tissues_), 0));
  if (!one_grey.solved) return one_grey;
  std::vector<int> group;
  int groups = 1;  // group 0 is blood
  for (const bool blood : blood_) group.push_back(blood ? 0 : groups++);
  const auto some = std::find(blood_.begin(), blood_.end(), true);
  for (;;) {
    Fit fit = solve(group);
    fit.total = one_grey.residual;
    if (!fit.solved || some == blood_.end()) return fit;
    const double blood = fit.grey[static_cast<std::size_t>(some - blood_.begin())];
    int darkest = -1;
    for (std::size_t t = 0; t < group.size(); ++t)
      if (group[t] != 0 && fit.grey[t] < blood &&
          (darkest < 0 || fit.grey[t] < fit.grey[static_cast<std::size_t>(darkest)]))
        darkest = static_cast<int>(t);
    if (darkest < 0) return fit;
    const int gone = group[static_cast<std::size_t>(darkest)];
    for (int& g : group) g = g == gone ? 0 : g > gone ? g - 1 : g;
  }
}

}  // namespace echocine::fit
