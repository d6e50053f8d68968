#include "fit/fit_polish.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <utility>

#include "core/error.h"
#include "core/hash_random.h"
#include "core/parallel.h"

namespace echocine::fit {

namespace {

constexpr double kFirstWidth = 2.5, kShrink = 0.9;  // in standard deviations; a round's factor
constexpr double kWidest = 1.2;        // steps of an unknown; beyond, J is no quadratic
constexpr double kFarthest = 1.5;      // widths, of the way to a minimum
constexpr double kLeastWeight = 0.01;  // of a place in a regression
constexpr double kPlaceNoise = 1;      // of a single J, above that of a regression's minimum

FitPlace lowestOf(const std::vector<FitPlace>& places) {
  return *std::min_element(places.begin(), places.end(),
                           [](const FitPlace& a, const FitPlace& b) { return a.cost < b.cost; });
}

// Principal axes of a covariance of the unknowns that are not held, in steps.
class Axes {
 public:
  Axes(const FitCost& cost, const std::vector<double>& covariance, double width)
      : cost_(cost), width_(width) {
    const std::size_t all = cost.unknowns().size();
    for (std::size_t i = 0; i < all; ++i)
      if (!cost.unknowns()[i].held) free_.push_back(i);
    const auto n = static_cast<int>(free_.size());
    cv::Mat c(n, n, CV_64F);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const std::size_t u = free_[static_cast<std::size_t>(i)],
                          v = free_[static_cast<std::size_t>(j)];
        c.at<double>(i, j) =
            covariance[u * all + v] / cost.unknowns()[u].step / cost.unknowns()[v].step;
      }
    cv::Mat variance;
    cv::eigen(0.5 * (c + c.t()), variance, rows_);
    constexpr double kLeast = 1e-3;
    for (int i = 0; i < n; ++i)
      sds_.push_back(
          std::clamp(std::sqrt(std::max(0.0, variance.at<double>(i))), kLeast, kWidest / width));
  }

  // A draw of the normal distribution, `width` times as wide.
  std::vector<double> draw(std::size_t round, std::size_t pair) const {
    constexpr std::uint64_t kSeed = 22;
    std::vector<double> out(cost_.unknowns().size(), 0);
    for (std::size_t a = 0; a < sds_.size(); ++a) {
      const double z =
          width_ * sds_[a] *
          normalFromHashes(hashOf(kSeed, round, pair, a, 0), hashOf(kSeed, round, pair, a, 1));
      for (std::size_t i = 0; i < free_.size(); ++i) out[free_[i]] += z * component(a, i);
    }
    return out;
  }

  // Squared distance in standard deviations.
  double squareOf(const std::vector<double>& u) const {
    double sum = 0;
    for (std::size_t a = 0; a < sds_.size(); ++a) {
      double along = 0;
      for (std::size_t i = 0; i < free_.size(); ++i) along += u[free_[i]] * component(a, i);
      sum += along * along / (sds_[a] * sds_[a]);
    }
    return sum;
  }

  // By unknown; 0 of held ones.
  std::vector<double> sds() const {
    std::vector<double> out(cost_.unknowns().size(), 0);
    for (std::size_t i = 0; i < free_.size(); ++i) {
      double sum = 0;
      for (std::size_t a = 0; a < sds_.size(); ++a) sum += std::pow(sds_[a] * component(a, i), 2);
      out[free_[i]] = std::sqrt(sum);
    }
    return out;
  }
  std::size_t size() const { return free_.size(); }

 private:
  double component(std::size_t axis, std::size_t i) const {
    return rows_.at<double>(static_cast<int>(axis), static_cast<int>(i));
  }

  const FitCost& cost_;
  double width_;
  std::vector<std::size_t> free_;
  cv::Mat rows_;
  std::vector<double> sds_;
};

// Evaluated in parallel; both places of each pair.
std::vector<FitPlace> placesAbout(const FitCost& cost, const FitPlace& middle, const Axes& axes,
                                  std::size_t round, const Monitor& monitor) {
  std::vector<FitPlace> out(2 * polishPairs(cost.freeOf(0).size()));
  parallelBlocks(out.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      if (!monitor.keep_going()) throw JobError("stopped while a heart was fitted");
      std::vector<double> u = axes.draw(round, k / 2);
      for (double& one : u) one *= k % 2 == 0 ? 1 : -1;
      out[k] = cost.at(cost.moved(middle.at, u), middle.found);
    }
  });
  return out;
}

// Weights of Eq. 22; 0 for places that are too far away. A limit of an unknown can move places far
// along an axis of small SD: if too few places are near, the nearest ones have the least weight.
std::vector<double> weightsOf(const std::vector<double>& squares, double scale,
                              std::size_t needed) {
  std::vector<double> sorted = squares;
  const std::size_t last = std::min(needed, squares.size()) - 1;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(last),
                   sorted.end());
  const double farthest = std::max(sorted[last], -scale * std::log(kLeastWeight));
  std::vector<double> out;
  for (const double square : squares)
    out.push_back(square > farthest ? 0 : std::max(kLeastWeight, std::exp(-square / scale)));
  return out;
}

// The sum of the views' regressions and the prior, in steps from a place.
Quadratic regressionAbout(const FitCost& cost, const std::vector<double>& middle, const Axes& axes,
                          double width, const std::vector<FitPlace>& places) {
  const std::size_t n = middle.size();
  std::vector<std::vector<double>> steps;
  std::vector<double> squares;
  for (const FitPlace& place : places) {
    steps.push_back(cost.stepsBetween(middle, place.at));
    squares.push_back(axes.squareOf(steps.back()));
  }
  const std::vector<double> weights =
      weightsOf(squares, 2 * static_cast<double>(axes.size()) * width * width,
                2 * polishPairs(cost.freeOf(0).size()));
  std::vector<WeightedValue> values;
  std::vector<const FitPlace*> used;
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (!(weights[k] > 0)) continue;
    values.push_back({std::move(steps[k]), 0, weights[k]});
    used.push_back(&places[k]);
  }
  std::vector<Quadratic> views;
  for (std::size_t v = 0; v < cost.views(); ++v) {
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k].value = cost.viewCost(v, used[k]->at, used[k]->found[v]);
    views.push_back(regressionOf(n, cost.freeOf(v), values));
  }
  return cost.sumOf(views, middle);
}

FitPlace minimumOf(const FitCost& cost, const Quadratic& q, const FitPlace& middle,
                   const Axes& axes, double width) {
  std::vector<double> farthest;
  for (const double sd : axes.sds()) farthest.push_back(kFarthest * width * sd);
  return cost.at(cost.minimumNear(q, middle.at, farthest), middle.found);
}

// A regression through few places may be far too curved, and draws of the next round would then be
// too close together to mend it: no SD becomes much smaller in a round. Correlations stay.
void keepWide(const std::vector<double>& before, std::vector<double>& covariance) {
  constexpr double kLeast = 0.6;  // of an SD; our choice
  const auto n = static_cast<std::size_t>(std::lround(std::sqrt(covariance.size())));
  for (std::size_t i = 0; i < n; ++i) {
    const double variance = covariance[i * n + i],
                 wider = kLeast * std::sqrt(before[i * n + i] / variance);
    if (!(variance > 0 && wider > 1)) continue;
    for (std::size_t j = 0; j < n; ++j)
      covariance[i * n + j] *= wider, covariance[j * n + i] *= wider;
  }
}

}  // namespace

FitDescent polishFit(const FitCost& cost, FitDescent from, const Monitor& monitor,
                     std::size_t rounds) {
  if (from.covariance.empty()) return from;
  try {
    std::vector<FitPlace> places{from.best};
    double width = kFirstWidth;
    for (std::size_t round = 0; round < rounds; ++round, width *= kShrink) {
      const FitPlace middle = from.best;
      const Axes axes(cost, from.covariance, width);
      for (FitPlace& place : placesAbout(cost, middle, axes, round, monitor))
        places.push_back(std::move(place));
      const Quadratic q = regressionAbout(cost, middle.at, axes, width, places);
      const FitPlace lowest = lowestOf(places);
      places.push_back(minimumOf(cost, q, middle, axes, width));
      if (places.back().cost < middle.cost) from.best = places.back();
      if (lowest.cost < from.best.cost - kPlaceNoise) from.best = lowest;
      std::vector<double> covariance = cost.covariance(q);
      keepWide(from.covariance, covariance);
      from.covariance = std::move(covariance);
      monitor.tell({Task::settings, round + 1, rounds});
    }
  } catch (const JobError&) {
    if (monitor.keep_going()) throw;
    from.stopped = true;
  }
  return from;
}

}  // namespace echocine::fit
