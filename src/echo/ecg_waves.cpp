#include "echo/ecg_waves.h"

#include <algorithm>
#include <cmath>

namespace echocine::echo {

namespace {

struct Wave {
  double at = 0, prominence = 0, width = 1;
  double sharpness() const { return prominence / width; }
};

// Short gaps are bridged; longer ones are level with their sides.
std::vector<double> withoutGaps(std::span<const double> heights, double sign) {
  std::vector<double> out;
  double last = 0;
  for (std::size_t i = 0; i < heights.size(); ++i) {
    if (!std::isnan(heights[i])) {
      last = sign * heights[i];
      out.push_back(last);
      continue;
    }
    std::size_t next = i;
    while (next < heights.size() && std::isnan(heights[next])) ++next;
    const double after = next < heights.size() ? sign * heights[next] : last;
    const double level = i > 0 ? last : after;
    const auto gap = static_cast<double>(next - i + 1);
    for (std::size_t k = i; k < next; ++k)
      out.push_back(level + (after - level) * static_cast<double>(k - i + 1) / gap);
    i = next - 1;
  }
  return out;
}

// Every local maximum with its prominence within the reach of the trace on both sides.
std::vector<Wave> wavesOf(const std::vector<double>& y, double least) {
  std::vector<Wave> waves;
  const std::size_t n = y.size();
  for (std::size_t i = 1; i + 1 < n; ++i) {
    if (!(y[i] > y[i - 1])) continue;
    std::size_t end = i;
    while (end + 1 < n && y[end + 1] == y[i]) ++end;
    if (end + 1 >= n || y[end + 1] > y[i]) continue;
    double left = y[i], right = y[i];
    for (std::size_t k = i; k-- > 0 && y[k] <= y[i];) left = std::min(left, y[k]);
    for (std::size_t k = end + 1; k < n && y[k] <= y[i]; ++k) right = std::min(right, y[k]);
    Wave wave;
    wave.prominence = y[i] - std::max(left, right);
    if (wave.prominence < least) continue;
    wave.at = 0.5 * static_cast<double>(i + end);
    const double half = y[i] - 0.5 * wave.prominence;
    std::size_t a = i, b = end;
    while (a > 0 && y[a] > half) --a;
    while (b + 1 < n && y[b] > half) ++b;
    wave.width = std::max(1.0, static_cast<double>(b - a) - 1);
    waves.push_back(wave);
  }
  return waves;
}

double medianOfAll(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

// Our choice of numbers: a T wave is a third as tall as the R wave and three times as wide.
constexpr double kSharpPart = 0.4, kTallPart = 0.4, kMostWidth = 0.2;
// In units of the trace's own thickness.
constexpr double kLeastHeight = 4;
// Part of the samples beside R waves that leave the usual height: a scale's ticks stand on a
// straight line.
constexpr double kLeastAlive = 0.1;

RWaves toOneSide(std::span<const double> heights, double thickness, double sign,
                 double& sharpness) {
  const std::vector<double> y = withoutGaps(heights, sign);
  std::vector<Wave> waves = wavesOf(y, kLeastHeight * std::max(1.0, thickness));
  RWaves out;
  sharpness = 0;
  if (waves.empty()) return out;
  std::stable_sort(waves.begin(), waves.end(),
                   [](const Wave& a, const Wave& b) { return a.sharpness() > b.sharpness(); });
  const Wave sharpest = waves.front();
  std::vector<Wave> found;
  double other = 0;
  for (const Wave& w : waves)
    if (w.sharpness() >= kSharpPart * sharpest.sharpness() &&
        w.prominence >= kTallPart * sharpest.prominence)
      found.push_back(w);
    else
      other = std::max(other, w.sharpness());
  std::sort(found.begin(), found.end(), [](const Wave& a, const Wave& b) { return a.at < b.at; });
  std::vector<double> widths, steps, sharp;
  for (std::size_t i = 0; i < found.size(); ++i) {
    out.at.push_back(found[i].at);
    widths.push_back(found[i].width);
    sharp.push_back(found[i].sharpness());
    if (i > 0) steps.push_back(found[i].at - found[i - 1].at);
  }
  sharpness = medianOfAll(sharp);
  const double step = steps.empty() ? static_cast<double>(y.size()) : medianOfAll(steps);
  if (medianOfAll(widths) > kMostWidth * step) return out;
  // An early beat and the pause after it are regular enough: half of the steps are similar.
  // No heart beats twice in a third of its beat. Shares of the median step, our choice.
  constexpr double kMostOff = 0.5, kLeastStep = 0.35;
  std::vector<double> off;
  for (const double s : steps) {
    off.push_back(std::abs(s - step));
    if (s < kLeastStep * step) return out;
  }
  if (steps.size() > 2 && medianOfAll(off) > kMostOff * step) return out;
  double alive = 0, all = 0;
  const double level = medianOfAll(y);
  for (std::size_t i = 0; i < y.size(); ++i) {
    bool wave = false;
    for (const Wave& w : found)
      wave = wave || std::abs(static_cast<double>(i) - w.at) < 2 * w.width + 2;
    if (wave) continue;
    ++all;
    if (std::abs(y[i] - level) > 1.01) ++alive;
  }
  if (alive < kLeastAlive * all) return out;
  double least = sharp.front();
  for (const double s : sharp) least = std::min(least, s);
  out.confidence = std::clamp(1 - other / least, 0.0, 1.0);
  return out;
}

}  // namespace

RWaves findRWaves(std::span<const double> heights, double thickness) {
  double up = 0, down = 0;
  RWaves above = toOneSide(heights, thickness, 1, up),
         below = toOneSide(heights, thickness, -1, down);
  return up >= down ? above : below;
}

}  // namespace echocine::echo
