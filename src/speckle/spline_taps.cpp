#include "speckle/spline_taps.h"

#include <algorithm>
#include <cmath>

#include "speckle/point_spread.h"

namespace echocine {

namespace {

constexpr double kReach = 3;  // of taps, in standard deviations. Our choice: 1 % of the amplitude
constexpr int kPerSpacing = 64;  // points of the fit

struct FitPoint {
  double value, weight;
};

double splineSum(std::span<const double> taps, int first, double x) {
  const int before = static_cast<int>(std::floor(x)) - 1;
  const std::array<double, 4> weights = splineWeights(x - std::floor(x));
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const int n = before + i - first;
    if (n >= 0 && n < static_cast<int>(taps.size()))
      sum += taps[static_cast<std::size_t>(n)] * weights[static_cast<std::size_t>(i)];
  }
  return sum;
}

// Solves a symmetric positive definite band system with three diagonals to either side.
class BandSystem {
 public:
  explicit BandSystem(int size) : size_(size), rows_(static_cast<std::size_t>(size)) {}
  double& at(int row, int column) {
    return rows_[static_cast<std::size_t>(row)].band[column - row];
  }
  double& right(int row) { return rows_[static_cast<std::size_t>(row)].right; }

  std::vector<double> solve() {
    for (int i = 0; i < size_; ++i)
      for (int j = i + 1; j < std::min(i + 4, size_); ++j) {
        const double part = at(i, j) / at(i, i);
        for (int k = j; k < std::min(i + 4, size_); ++k) at(j, k) -= part * at(i, k);
        right(j) -= part * right(i);
      }
    std::vector<double> out(static_cast<std::size_t>(size_));
    for (int i = size_ - 1; i >= 0; --i) {
      double sum = right(i);
      for (int j = i + 1; j < std::min(i + 4, size_); ++j)
        sum -= at(i, j) * out[static_cast<std::size_t>(j)];
      out[static_cast<std::size_t>(i)] = sum / at(i, i);
    }
    return out;
  }

 private:
  struct Row {
    double band[4] = {}, right = 0;  // from the diagonal on
  };
  int size_;
  std::vector<Row> rows_;
};

// Taps whose spline sum is closest to a function, over all x that the nodes reach.
template <typename Target>
std::vector<double> fittedTaps(TapRange range, const Target& target) {
  BandSystem system(range.count);
  for (int i = 0; i < (range.count + 3) * kPerSpacing; ++i) {
    const int cell = i / kPerSpacing;  // its nodes are cell - 3 to cell, from the first tap
    const double t = (i % kPerSpacing + 0.5) / kPerSpacing;
    const FitPoint point = target(range.first - 2 + cell + t);
    const std::array<double, 4> weights = splineWeights(t);
    for (int a = 0; a < 4; ++a) {
      const int row = cell - 3 + a;
      if (row < 0 || row >= range.count) continue;
      const double weighted = point.weight * weights[static_cast<std::size_t>(a)];
      system.right(row) += weighted * point.value;
      for (int b = a; b < 4 && cell - 3 + b < range.count; ++b)
        system.at(row, cell - 3 + b) += weighted * weights[static_cast<std::size_t>(b)];
    }
  }
  return system.solve();
}

}  // namespace

std::array<double, 4> splineWeights(double t) {
  const double s = 1 - t;
  return {s * s * s / 6, 2.0 / 3 - t * t + t * t * t / 2, 2.0 / 3 - s * s + s * s * s / 2,
          t * t * t / 6};
}

TapRange tapRange(double deviation, double first_phase, double last_phase) {
  const double reach = std::max(kReach * deviation - 0.25, 1.0);
  const int first = static_cast<int>(std::ceil(first_phase - reach)),
            last = static_cast<int>(std::floor(last_phase + reach));
  return {first, last - first + 1};
}

std::vector<double> amplitudeTaps(double deviation, double phase, TapRange range) {
  return fittedTaps(range, [&](double x) { return FitPoint{bell(x - phase, deviation), 1}; });
}

// The weight is between those of the absolute and of the relative error, down to -50 dB. No tap is
// negative, so the sum of powers is not either.
std::vector<double> powerTaps(std::span<const double> amplitude_taps, TapRange range) {
  constexpr double kLeast = 1e-5;
  std::vector<double> taps = fittedTaps(range, [&](double x) {
    const double amplitude = splineSum(amplitude_taps, range.first, x),
                 power = amplitude * amplitude;
    return FitPoint{power, 1 / (power + kLeast)};
  });
  for (double& tap : taps) tap = std::max(tap, 0.0);
  return taps;
}

}  // namespace echocine
