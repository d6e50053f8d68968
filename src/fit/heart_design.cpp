#include "fit/heart_design.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

#include "core/check.h"
#include "core/error.h"
#include "core/hash_random.h"

namespace echocine::fit {

namespace {

constexpr std::size_t kCubic = 2;  // dials of degree 3: the first

// Chebyshev-Lobatto: ends included, dense towards them, so the polynomial stays tame.
double nodeOf(int node, int nodes) {
  return std::cos(std::numbers::pi * (nodes - 1 - node) / (nodes - 1));
}

// Lagrange's polynomials of the nodes at t.
std::vector<double> lagrange(int nodes, double t) {
  std::vector<double> out;
  for (int i = 0; i < nodes; ++i) {
    double product = 1;
    for (int j = 0; j < nodes; ++j)
      if (j != i) product *= (t - nodeOf(j, nodes)) / (nodeOf(i, nodes) - nodeOf(j, nodes));
    out.push_back(product);
  }
  return out;
}

// How far a polynomial through nodes may leave the middle of its values there, over half their
// range: a bound of Lebesgue's constant for these nodes (Trefethen, Approximation Theory and
// Approximation Practice, 2013, theorem 15.2).
double mostOvershoot(int nodes) {
  return 1 + 2 / std::numbers::pi * std::log(static_cast<double>(nodes));
}

// Every combination of the nodes in units, the first dial fastest.
std::vector<std::vector<double>> latticeOf(std::size_t dials, int nodes) {
  std::vector<std::vector<double>> out{{}};
  for (std::size_t r = 0; r < dials; ++r) {
    std::vector<std::vector<double>> next;
    for (int node = 0; node < nodes; ++node)
      for (std::vector<double> place : out) {
        place.push_back(nodeOf(node, nodes));
        next.push_back(std::move(place));
      }
    out = std::move(next);
  }
  return out;
}

// Total degree 2, and 3 in the first two dials. Dials of the sections have degree 1, alone and
// times the first two.
std::vector<std::vector<int>> powersFor(const std::vector<DialRange>& ranges) {
  std::vector<std::vector<int>> out;
  std::vector<int> p(ranges.size(), 0);
  const auto addWith = [&](std::size_t a, std::size_t b, std::size_t c) {
    p.assign(ranges.size(), 0);
    for (const std::size_t dial : {a, b, c})
      if (dial < p.size()) ++p[dial];
    if (std::find(out.begin(), out.end(), p) == out.end()) out.push_back(p);
  };
  const std::size_t n = ranges.size(), none = n;
  const auto isLinear = [&](std::size_t dial) {
    return dial >= kCubic && heart::isSectionDial(ranges[dial].key);
  };
  addWith(none, none, none);
  for (std::size_t a = 0; a < n; ++a) {
    addWith(a, none, none);
    for (std::size_t b = 0; b <= a; ++b)
      if (b < kCubic || !(isLinear(a) || isLinear(b))) addWith(a, b, none);
  }
  for (std::size_t a = 0; a < std::min(n, kCubic); ++a)
    for (std::size_t b = 0; b <= a; ++b)
      for (std::size_t c = 0; c <= b; ++c) addWith(a, b, c);
  // By the last dial first.
  std::sort(out.begin(), out.end(), [](const auto& one, const auto& other) {
    return std::lexicographical_compare(one.rbegin(), one.rend(), other.rbegin(), other.rend());
  });
  return out;
}

// Places that a polynomial may take.
std::vector<std::vector<double>> candidatesOf(std::size_t dials) {
  constexpr int kNodes = 4;
  constexpr std::size_t kMostOfLattice = 9, kDraws = std::size_t{1} << 16;
  if (dials <= kMostOfLattice) return latticeOf(dials, kNodes);
  constexpr std::uint64_t kSeed = 15;
  std::vector<std::vector<double>> out(kDraws);
  for (std::size_t i = 0; i < kDraws; ++i)
    for (std::size_t r = 0; r < dials; ++r)
      out[i].push_back(nodeOf(static_cast<int>(hashOf(kSeed, i, r) % kNodes), kNodes));
  return out;
}

double chebyshev(int degree, double t) {
  return degree == 0 ? 1 : degree == 1 ? t : degree == 2 ? 2 * t * t - 1 : (4 * t * t - 3) * t;
}

cv::Mat rowOf(const std::vector<std::vector<int>>& powers, const std::vector<double>& unit) {
  cv::Mat row(1, static_cast<int>(powers.size()), CV_64F);
  for (std::size_t k = 0; k < powers.size(); ++k) {
    double product = 1;
    for (std::size_t r = 0; r < unit.size(); ++r) product *= chebyshev(powers[k][r], unit[r]);
    row.at<double>(static_cast<int>(k)) = product;
  }
  return row;
}

}  // namespace

HeartDesign HeartDesign::grid(const std::vector<DialRange>& ranges, int nodes) {
  HeartDesign out;
  out.ranges_ = ranges;
  out.nodes_ = nodes;
  out.places_ = latticeOf(ranges.size(), nodes);
  out.overshoot_ = std::pow(mostOvershoot(nodes), static_cast<double>(ranges.size()));
  return out;
}

HeartDesign HeartDesign::polynomial(const std::vector<DialRange>& ranges) {
  HeartDesign out;
  out.ranges_ = ranges;
  out.powers_ = powersFor(ranges);
  const std::size_t hearts = out.powers_.size() + (out.powers_.size() + 4) / 5;
  if (hearts > kMostHearts)
    throw SceneError(
        fmt::format("ranges: needs {} hearts, accepted: up to {}", hearts, kMostHearts));
  const std::vector<std::vector<double>> lattice = candidatesOf(ranges.size());
  const int terms = static_cast<int>(out.powers_.size());
  cv::Mat rows(static_cast<int>(lattice.size()), terms, CV_64F);
  for (int i = 0; i < rows.rows; ++i)
    rowOf(out.powers_, lattice[static_cast<std::size_t>(i)]).copyTo(rows.row(i));
  constexpr double kUnknown = 1e6;  // variance of a term without hearts
  cv::Mat spread = kUnknown * cv::Mat::eye(terms, terms, CV_64F);
  std::vector<double> variances(lattice.size());  // of the rows
  for (int i = 0; i < rows.rows; ++i)
    variances[static_cast<std::size_t>(i)] = kUnknown * rows.row(i).dot(rows.row(i));
  const auto take = [&](const std::vector<double>& place, const cv::Mat& row) {
    out.places_.push_back(place);
    const cv::Mat seen = (spread * row.t()).t();
    const double all = 1 + row.dot(seen);
    spread -= seen.t() * seen / all;
    for (int i = 0; i < rows.rows; ++i)
      variances[static_cast<std::size_t>(i)] -= std::pow(rows.row(i).dot(seen), 2) / all;
  };
  const std::vector<double> centre(ranges.size(), 0);
  take(centre, rowOf(out.powers_, centre));
  while (out.places_.size() < hearts) {
    std::size_t best = 0;
    double most = -1;
    for (std::size_t i = 0; i < variances.size(); ++i)
      if (variances[i] > most * (1 + 1e-9)) most = variances[i], best = i;
    take(lattice[best], rows.row(static_cast<int>(best)));
  }
  out.settle();
  return out;
}

std::vector<double> HeartDesign::at(std::size_t place) const {
  std::vector<double> out;
  for (std::size_t r = 0; r < ranges_.size(); ++r)
    out.push_back(0.5 * (ranges_[r].low + ranges_[r].high) +
                  0.5 * (ranges_[r].high - ranges_[r].low) * places_[place][r]);
  return out;
}

void HeartDesign::moveIn(std::size_t place) {
  CHECK_EQ(nodes_, 0);
  for (double& t : places_[place]) t *= 0.75;
}

void HeartDesign::settle() {
  cv::Mat all;
  for (const std::vector<double>& place : places_) all.push_back(rowOf(powers_, place));
  cv::Mat inverse;
  cv::invert(all, inverse, cv::DECOMP_SVD);  // pseudo-inverse: terms x places
  solver_.assign(inverse.begin<double>(), inverse.end<double>());
  // Over the candidates, where polynomials are largest; the margin covers other places.
  constexpr double kMargin = 1.1;
  overshoot_ = 1;
  for (const std::vector<double>& place : candidatesOf(ranges_.size())) {
    double sum = 0;
    for (const double share : sharesOf(place)) sum += std::abs(share);
    overshoot_ = std::max(overshoot_, kMargin * sum);
  }
}

std::vector<double> HeartDesign::unit(const std::vector<double>& values) const {
  std::vector<double> out;
  for (std::size_t r = 0; r < ranges_.size(); ++r)
    out.push_back((2 * values[r] - ranges_[r].low - ranges_[r].high) /
                  (ranges_[r].high - ranges_[r].low));
  return out;
}

std::vector<double> HeartDesign::sharesOf(const std::vector<double>& unit) const {
  if (nodes_ == 0) {
    const cv::Mat row = rowOf(powers_, unit);
    std::vector<double> out(places_.size(), 0);
    for (std::size_t k = 0; k < powers_.size(); ++k)
      for (std::size_t n = 0; n < out.size(); ++n)
        out[n] += row.at<double>(static_cast<int>(k)) * solver_[k * out.size() + n];
    return out;
  }
  // Products of the polynomials of each dial, node by node.
  std::vector<double> out{1};
  for (const double t : unit) {
    std::vector<double> next;
    for (const double own : lagrange(nodes_, t))
      for (const double before : out) next.push_back(own * before);
    out = std::move(next);
  }
  return out;
}

std::vector<float> HeartDesign::shares(const std::vector<double>& values) const {
  const std::vector<double> out = sharesOf(unit(values));
  return {out.begin(), out.end()};
}

}  // namespace echocine::fit
