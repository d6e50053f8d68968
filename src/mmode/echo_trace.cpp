#include "mmode/echo_trace.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace echocine {

namespace {

constexpr double kStep_s = 0.005, kMostVelocity = 0.4;  // m/s
constexpr double kStart_m = 3e-3, kMean_m = 1e-3;
constexpr double kClimb_m = 1.5e-3;
constexpr double kUsualVelocity = 0.15, kCost = 0.2;  // m/s, grey levels

// The mean over `half` samples on either side, as far as the line reaches.
std::vector<double> smoothed(std::span<const float> line, int half) {
  const int samples = static_cast<int>(line.size());
  std::vector<double> out;
  for (int k = 0; k < samples; ++k) {
    const int first = std::max(k - half, 0), last = std::min(k + half, samples - 1);
    double sum = 0;
    for (int j = first; j <= last; ++j) sum += line[static_cast<std::size_t>(j)];
    out.push_back(sum / (last - first + 1));
  }
  return out;
}

// The maximum next to sample k, at most `most` samples away.
int climbed(const std::vector<double>& line, int k, int most) {
  const auto at = [&](int i) {
    return i < 0 || i >= static_cast<int>(line.size()) ? -1 : line[static_cast<std::size_t>(i)];
  };
  for (int steps = 0; steps < most; ++steps) {
    const int up = at(k + 1) > at(k) ? k + 1 : k;
    k = at(k - 1) > at(up) ? k - 1 : up;
  }
  return k;
}

// Where the parabola through three values has its maximum, in samples from the middle one.
double peakOffset(const std::vector<double>& line, int k) {
  if (k == 0 || k + 1 == static_cast<int>(line.size())) return 0;
  const auto at = static_cast<std::size_t>(k);
  const double bend = line[at - 1] - 2 * line[at] + line[at + 1];
  return bend < 0 ? std::clamp(0.5 * (line[at - 1] - line[at + 1]) / bend, -0.5, 0.5) : 0;
}

// The best path through lines of equal length, by samples. The first one is within `about` of
// `start`. costs: of a step by 0, 1, ... samples; longer steps are not taken.
std::vector<int> bestPath(const std::vector<std::vector<double>>& lines, int start, int about,
                          const std::vector<double>& costs) {
  const int samples = static_cast<int>(lines.front().size());
  const int most = static_cast<int>(costs.size()) - 1;
  const double none = -std::numeric_limits<double>::infinity();
  std::vector<double> sum(lines.front().size(), none);
  for (int k = std::max(start - about, 0); k <= std::min(start + about, samples - 1); ++k)
    sum[static_cast<std::size_t>(k)] = lines.front()[static_cast<std::size_t>(k)];
  std::vector<std::vector<int>> from(lines.size(), std::vector<int>(lines.front().size(), 0));
  for (std::size_t t = 1; t < lines.size(); ++t) {
    std::vector<double> next(sum.size(), none);
    for (int k = 0; k < samples; ++k) {
      double best = none;
      for (int j = std::max(k - most, 0); j <= std::min(k + most, samples - 1); ++j) {
        const double value =
            sum[static_cast<std::size_t>(j)] - costs[static_cast<std::size_t>(std::abs(j - k))];
        if (value <= best) continue;
        best = value;
        from[t][static_cast<std::size_t>(k)] = j;
      }
      next[static_cast<std::size_t>(k)] = best + lines[t][static_cast<std::size_t>(k)];
    }
    sum = std::move(next);
  }
  std::vector<int> path(lines.size());
  path.back() = static_cast<int>(std::max_element(sum.begin(), sum.end()) - sum.begin());
  for (std::size_t t = lines.size() - 1; t > 0; --t)
    path[t - 1] = from[t][static_cast<std::size_t>(path[t])];
  return path;
}

}  // namespace

std::vector<double> followEcho(const EchoColumns& in, double start_m) {
  const auto inSamples = [&](double m) { return static_cast<int>(std::lround(m / in.sample_m)); };
  const int step = std::max(1, static_cast<int>(std::lround(kStep_s / in.column_s)));
  const double step_s = step * in.column_s;
  std::vector<double> costs;
  for (int k = 0; k <= std::max(1, inSamples(kMostVelocity * step_s)); ++k) {
    const double share = k * in.sample_m / step_s / kUsualVelocity;
    costs.push_back(kCost * share * share);
  }
  std::vector<int> at;
  std::vector<std::vector<double>> lines;
  for (int t = 0; t < in.columns;
       t = t + 1 == in.columns ? in.columns : std::min(t + step, in.columns - 1)) {
    const auto samples = static_cast<std::size_t>(in.samples);
    at.push_back(t);
    lines.push_back(smoothed(in.greys.subspan(static_cast<std::size_t>(t) * samples, samples),
                             inSamples(0.5 * kMean_m)));
  }
  const int start = std::clamp(static_cast<int>(start_m / in.sample_m), 0, in.samples - 1);
  const std::vector<int> path = bestPath(lines, start, std::max(1, inSamples(kStart_m)), costs);

  std::vector<double> depth_m, moved(static_cast<std::size_t>(in.columns), 0.0);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const int peak = climbed(lines[i], path[i], inSamples(kClimb_m));
    depth_m.push_back((peak + peakOffset(lines[i], peak)) * in.sample_m);
  }
  for (std::size_t i = 0; i + 1 < at.size(); ++i)
    for (int t = at[i] + 1; t <= at[i + 1]; ++t) {
      const double share = static_cast<double>(t - at[i]) / (at[i + 1] - at[i]);
      moved[static_cast<std::size_t>(t)] =
          depth_m.front() - depth_m[i] - share * (depth_m[i + 1] - depth_m[i]);
    }
  return moved;
}

}  // namespace echocine
