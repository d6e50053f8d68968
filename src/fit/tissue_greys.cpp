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
      moments_(blood.size() * (kGainKnots - 1) * kMoments, 0),
      mixed_{std::vector<double>(
                 static_cast<std::size_t>(unknowns_) * static_cast<std::size_t>(unknowns_), 0),
             std::vector<double>(static_cast<std::size_t>(unknowns_), 0)},
      expected_((kGainKnots - 1) * kDoubleLanes, 0) {}

void TissueGreys::Sums::add(const int* at, const double* value, int parts, int unknowns, double g,
                            double w) {
  for (int a = 0; a < parts; ++a) {
    const double wa = w * value[a];
    double* row = normal.data() + at[a] * unknowns;
    for (int b = 0; b <= a; ++b) row[at[b]] += wa * value[b];
    right[static_cast<std::size_t>(at[a])] += wa * g;
  }
  weight += w;
  square += w * g * g;
}

void TissueGreys::addMixed(int first, int second, double share, int knot, double high, double g,
                           double weight) {
  const int at[] = {tissues_ + knot, tissues_ + knot + 1, first, second};
  const double value[] = {1 - high, high, share, 1 - share};
  mixed_.add(at, value, 4, unknowns_, g, weight);
}

// A cell at h has 1 - h of a knot, h of the next, and its tissue.
TissueGreys::Sums TissueGreys::all() const {
  Sums out = mixed_;
  const double* m = moments_.data();
  for (int tissue = 0; tissue < tissues_; ++tissue)
    for (int knot = tissues_; knot + 1 < unknowns_; ++knot, m += kMoments) {
      const double w = m[0], h = m[1], hh = m[2], g = m[3], hg = m[4];
      const auto normal = [&](int row, int column) -> double& {
        return out.normal[static_cast<std::size_t>(row * unknowns_ + column)];
      };
      const auto right = [&](int row) -> double& {
        return out.right[static_cast<std::size_t>(row)];
      };
      normal(knot, knot) += w - 2 * h + hh;
      normal(knot + 1, knot) += h - hh;
      normal(knot + 1, knot + 1) += hh;
      normal(tissue, knot) += w - h;
      normal(tissue, knot + 1) += h;
      normal(tissue, tissue) += w;
      right(knot) += g - hg;
      right(knot + 1) += hg;
      right(tissue) += g;
      out.weight += w;
      out.square += m[5];
    }
  return out;
}

// The same cells with their whole grey levels, for a fit of all tissues as one.
TissueGreys::Sums TissueGreys::withExpected(Sums sums) const {
  const double* m = expected_.data();
  for (std::size_t knot = static_cast<std::size_t>(tissues_); knot + 1 < sums.right.size();
       ++knot, m += kDoubleLanes) {
    sums.right[0] += m[0];
    sums.right[knot] += m[0] - m[1];
    sums.right[knot + 1] += m[1];
    sums.square += m[2];
  }
  return sums;
}

double TissueGreys::Fit::left(int first, int second, double share, double depth, double g) const {
  const double place = std::clamp(depth, 0.0, 1.0) * (kGainKnots - 1);
  const int knot = std::min(static_cast<int>(place), kGainKnots - 2);
  const double gain_here = gain[knot] + (place - knot) * (gain[knot + 1] - gain[knot]);
  const double of_tissues = share * grey[static_cast<std::size_t>(first)] +
                            (share < 1 ? (1 - share) * grey[static_cast<std::size_t>(second)] : 0);
  return g - of_tissues - gain_here;
}

// Least squares with tissues that share a group sharing their grey. Gains add up to what greys do
// too: a ridge of 1e-9 of the weight decides between them and changes nothing that is seen.
TissueGreys::Fit TissueGreys::solve(const Sums& sums, const std::vector<int>& group_of) const {
  const int groups = *std::max_element(group_of.begin(), group_of.end()) + 1,
            n = groups + kGainKnots;
  cv::Mat a = cv::Mat::zeros(n, n, CV_64F), b = cv::Mat::zeros(n, 1, CV_64F), x;
  Fit fit;
  fit.residual = std::numeric_limits<double>::infinity();
  fit.grey.assign(static_cast<std::size_t>(tissues_), std::numeric_limits<double>::quiet_NaN());
  const auto to = [&](int i) {
    return i < tissues_ ? group_of[static_cast<std::size_t>(i)] : i - tissues_ + groups;
  };
  for (int i = 0; i < unknowns_; ++i) {
    b.at<double>(to(i)) += sums.right[static_cast<std::size_t>(i)];
    for (int j = 0; j < unknowns_; ++j) {
      const auto at = [&](int row, int column) {
        return sums.normal[static_cast<std::size_t>(row * unknowns_ + column)];
      };
      a.at<double>(to(i), to(j)) += at(i, j) + (i == j ? 0 : at(j, i));
    }
  }
  cv::Mat ridged = a.clone();
  for (int i = 0; i < n; ++i) ridged.at<double>(i, i) += 1e-9 * sums.weight;
  if (!cv::solve(ridged, b, x, cv::DECOMP_CHOLESKY) || !cv::checkRange(x)) return fit;
  // From the sums themselves, not as reported by the solver. A value below 0 by more than rounding
  // is no least-squares residual.
  const double residual = sums.square - 2 * x.dot(b) + x.dot(a * x);
  if (!(residual >= -1e-9 * std::abs(sums.square))) return fit;
  fit.solved = true;
  fit.residual = std::max(0.0, residual);
  double mean = 0;
  for (int k = 0; k < kGainKnots; ++k) mean += x.at<double>(groups + k) / kGainKnots;
  for (int k = 0; k < kGainKnots; ++k) fit.gain[k] = x.at<double>(groups + k) - mean;
  for (int t = 0; t < tissues_; ++t)
    if (sums.normal[static_cast<std::size_t>(t * unknowns_ + t)] > 1e-6 * sums.weight)
      fit.grey[static_cast<std::size_t>(t)] =
          x.at<double>(group_of[static_cast<std::size_t>(t)]) + mean;
  return fit;
}

// Tissues darker than blood are pooled with it, the darkest first, until none is: the least squares
// under that order (pooling of violators, Barlow et al. 1972).
TissueGreys::Fit TissueGreys::fit() const {
  const Sums sums = all();
  const Fit one_grey =
      solve(withExpected(sums), std::vector<int>(static_cast<std::size_t>(tissues_), 0));
  if (!one_grey.solved) return one_grey;
  std::vector<int> group;
  int groups = 1;  // group 0 is blood
  for (const bool blood : blood_) group.push_back(blood ? 0 : groups++);
  // All blood has one grey, which a tissue has if it is seen.
  const auto grey_of_blood = [&](const Fit& fit) {
    for (std::size_t t = 0; t < blood_.size(); ++t)
      if (blood_[t] && std::isfinite(fit.grey[t])) return fit.grey[t];
    return std::numeric_limits<double>::quiet_NaN();
  };
  for (;;) {
    Fit fit = solve(sums, group);
    fit.total = one_grey.residual;
    if (!fit.solved) return fit;
    const double blood = grey_of_blood(fit);
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
