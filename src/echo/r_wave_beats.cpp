#include "echo/r_wave_beats.h"

#include <algorithm>
#include <cmath>

namespace echocine::echo {

namespace {

// The lower one of two.
double lowerMedianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

int beatsBetween(double interval, double beat) {
  constexpr double kNear = 0.25;  // our choice
  if (!(beat > 0)) return 1;
  const double times = std::round(interval / beat);
  return times > 1 && std::abs(interval / beat - times) < kNear ? static_cast<int>(times) : 1;
}

RWaveBeat beatOfRWaves(const std::vector<double>& waves, double seen) {
  if (waves.size() < 2) return {};
  std::vector<double> steps;
  for (std::size_t i = 1; i < waves.size(); ++i) steps.push_back(waves[i] - waves[i - 1]);
  // More than two missing waves in a row are not assumed.
  constexpr double kMostDivided = 3;
  double usual = lowerMedianOf(steps);
  if (const int times = beatsBetween(usual, seen); times <= kMostDivided) usual /= times;
  double beats = 0;
  std::vector<double> lengths;
  for (const double step : steps) {
    const int times = beatsBetween(step, usual);
    beats += times;
    lengths.push_back(step / times);
  }
  return {(waves.back() - waves.front()) / beats, lowerMedianOf(lengths)};
}

}  // namespace echocine::echo
