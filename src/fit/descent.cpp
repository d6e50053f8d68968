#include "fit/descent.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "core/parallel.h"

namespace echocine::fit {

namespace {

// Gradient and Hessian of the unknowns that may move.
struct Local {
  cv::Mat gradient, hessian;
};

std::vector<std::size_t> movable(const SearchBox& box) {
  std::vector<std::size_t> out;
  for (std::size_t u = 0; u < kUnknowns; ++u)
    if (box.high[u] > box.low[u]) out.push_back(u);
  return out;
}

// `crossed`: mixed derivatives too; else those that `out` has stay.
void differences(const PoseFunction& f, const Descent& from, const SearchBox& box,
                 const std::vector<std::size_t>& unknowns, double step, bool crossed, Local& out) {
  const int n = static_cast<int>(unknowns.size());
  std::vector<Unknowns> places;
  const auto add = [&](std::size_t u, double a, std::size_t v, double b) {
    Unknowns at = from.at;
    at[u] += a;
    at[v] += b;
    places.push_back(box.clamped(at));
  };
  for (const std::size_t u : unknowns) {
    add(u, step, u, 0);
    add(u, -step, u, 0);
  }
  for (std::size_t i = 0; crossed && i < unknowns.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) add(unknowns[i], step, unknowns[j], step);
  const std::vector<double> values = f(places);
  const auto plus = [&](int i) { return values[static_cast<std::size_t>(2 * i)]; };
  for (int i = 0; i < n; ++i) {
    const double minus = values[static_cast<std::size_t>(2 * i + 1)];
    out.gradient.at<double>(i) = (plus(i) - minus) / (2 * step);
    out.hessian.at<double>(i, i) = (plus(i) - 2 * from.value + minus) / (step * step);
  }
  auto both = values.begin() + 2 * n;
  for (int i = 0; crossed && i < n; ++i)
    for (int j = 0; j < i; ++j, ++both)
      out.hessian.at<double>(i, j) = out.hessian.at<double>(j, i) =
          (*both - plus(i) - plus(j) + from.value) / (step * step);
}

// Newton's step with all curvatures made positive, no longer than three units.
Unknowns newtonStep(const Local& local, const std::vector<std::size_t>& unknowns) {
  cv::Mat values, vectors;
  if (!cv::checkRange(local.hessian) || !cv::checkRange(local.gradient) ||
      !cv::eigen(local.hessian, values, vectors))
    return {};
  const double largest =
      std::max(std::abs(values.at<double>(0)), std::abs(values.at<double>(values.rows - 1)));
  const double least = std::max(1e-3 * largest, 1e-9);
  cv::Mat step = cv::Mat::zeros(local.gradient.rows, 1, CV_64F);
  for (int i = 0; i < values.rows; ++i) {
    const double along = vectors.row(i).dot(local.gradient.t());
    step -= (along / std::max(std::abs(values.at<double>(i)), least)) * vectors.row(i).t();
  }
  constexpr double kLongest = 3;
  const double length = cv::norm(step);
  if (length > kLongest) step *= kLongest / length;
  Unknowns out{};
  for (int i = 0; i < step.rows; ++i)
    out[unknowns[static_cast<std::size_t>(i)]] = step.at<double>(i);
  return out;
}

}  // namespace

Unknowns SearchBox::clamped(const Unknowns& at) const {
  Unknowns out{};
  for (std::size_t u = 0; u < kUnknowns; ++u) out[u] = std::clamp(at[u], low[u], high[u]);
  return out;
}

bool SearchBox::atLimit(const Unknowns& at) const {
  constexpr double kNear = 5e-4;  // of the range
  for (const std::size_t u : movable(*this))
    if (std::min(at[u] - low[u], high[u] - at[u]) < kNear * (high[u] - low[u])) return true;
  return false;
}

bool standApart(const Unknowns& a, const Unknowns& b) {
  constexpr double kApart = 5;
  return std::hypot(a[0] - b[0], a[1] - b[1]) > kApart || std::abs(a[2] - b[2]) > kApart;
}

std::vector<Descent> lattice(const PoseFunction& f, const SearchBox& box,
                             const std::array<int, kUnknowns>& each_way) {
  std::vector<Descent> all{{box.clamped({}), 2}};
  for (std::size_t u = kUnknowns; u-- > 0;) {
    std::vector<Descent> finer;
    const int steps = box.high[u] > box.low[u] ? 2 * each_way[u] : 0;
    for (const Descent& d : all)
      for (int i = 0; i <= steps; ++i) {
        finer.push_back(d);
        if (steps > 0) finer.back().at[u] = box.low[u] + (box.high[u] - box.low[u]) * i / steps;
      }
    all = std::move(finer);
  }
  parallelBlocks(all.size(), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<Unknowns> places;
    for (std::size_t i = begin; i < end; ++i) places.push_back(all[i].at);
    const std::vector<double> values = f(places);
    for (std::size_t i = begin; i < end; ++i) all[i].value = values[i - begin];
  });
  return all;
}

std::vector<Descent> leastApart(std::vector<Descent> all, std::size_t most) {
  std::stable_sort(all.begin(), all.end(),
                   [](const Descent& a, const Descent& b) { return a.value < b.value; });
  std::vector<Descent> out;
  for (const Descent& d : all) {
    if (out.size() == most) break;
    if (std::all_of(out.begin(), out.end(),
                    [&](const Descent& o) { return standApart(o.at, d.at); }))
      out.push_back(d);
  }
  return out;
}

PoseFunction oneByOne(std::function<double(const Unknowns&)> f) {
  return [f = std::move(f)](std::span<const Unknowns> places) {
    std::vector<double> values;
    for (const Unknowns& at : places) values.push_back(f(at));
    return values;
  };
}

Descent descend(const PoseFunction& f, const Unknowns& start, const SearchBox& box) {
  const auto valueAt = [&](const Unknowns& at) { return f({&at, 1}).front(); };
  const std::vector<std::size_t> unknowns = movable(box);
  Descent best{start, valueAt(start)};
  const int n = static_cast<int>(unknowns.size());
  Local local{cv::Mat::zeros(n, 1, CV_64F), cv::Mat::zeros(n, n, CV_64F)};
  // Widths of the differences far from the bottom and near it; steps that need mixed derivatives
  // anew.
  constexpr double kWide = 1, kNarrow = 0.25, kFar = 1;
  double width = kWide;
  bool crossed = true;
  for (int iteration = 0; iteration < 12; ++iteration) {
    differences(f, best, box, unknowns, width, crossed, local);
    const Unknowns step = newtonStep(local, unknowns);
    bool better = false;
    double length = 0;
    for (double share = 1; share > 0.1 && !better; share /= 2) {
      Unknowns at = best.at;
      double square = 0;
      for (std::size_t u = 0; u < kUnknowns; ++u) {
        at[u] += share * step[u];
        square += share * share * step[u] * step[u];
      }
      at = box.clamped(at);
      const double value = valueAt(at);
      if (value < best.value) {
        better = true;
        best = {at, value};
        length = std::sqrt(square);
      }
    }
    const bool narrow = width == kNarrow;
    if (!better && narrow) break;
    // A fortieth of a unit is 50 micrometres in 15 cm. Within a unit mixed derivatives hardly
    // change.
    crossed = better && length > kFar;
    if (!better || length < 0.3) width = kNarrow;
    if (narrow && length < 0.025) break;
  }
  return best;
}

std::vector<Descent> descendAll(const PoseFunction& f, const std::vector<Descent>& starts,
                                const SearchBox& box) {
  std::vector<Descent> out(starts.size());
  parallelBlocks(out.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out[i] = descend(f, starts[i].at, box);
  });
  return out;
}

double confidenceOf(double best, double rival, double baseline) {
  return baseline > 0 ? std::clamp((std::min(rival, baseline) - best) / baseline, 0.0, 1.0) : 0;
}

}  // namespace echocine::fit
