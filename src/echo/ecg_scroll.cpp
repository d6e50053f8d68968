// Traces that move as a whole.

#include <algorithm>
#include <cmath>
#include <limits>

#include "echo/ecg_time.h"

namespace echocine::echo {

namespace {

// Correlation of frames `lag` apart, the later one moved to the right by `shift` columns.
double likeness(const EcgCurve& curve, int lag, double shift) {
  const auto n = static_cast<int>(curve.height_px.size());
  const int stride = 1 + n / 60;  // a minute of frames says no more
  double count = 0, a_sum = 0, b_sum = 0, aa = 0, bb = 0, ab = 0;
  for (int f = lag; f < n; f += stride) {
    const std::vector<float>&before = curve.height_px[static_cast<std::size_t>(f - lag)],
          &now = curve.height_px[static_cast<std::size_t>(f)];
    for (std::size_t x = 0; x < now.size(); ++x) {
      const double place = static_cast<double>(x) + shift;
      if (!(place >= 0 && place + 1 < static_cast<double>(before.size()))) continue;
      const auto at = static_cast<std::size_t>(place);
      const double part = place - static_cast<double>(at);
      const double a = static_cast<double>(now[x]),
                   b = (1 - part) * static_cast<double>(before[at]) +
                       part * static_cast<double>(before[at + 1]);
      if (std::isnan(a) || std::isnan(b)) continue;
      ++count, a_sum += a, b_sum += b, aa += a * a, bb += b * b, ab += a * b;
    }
  }
  const double va = count * aa - a_sum * a_sum, vb = count * bb - b_sum * b_sum;
  return count > 0 && va > 0 && vb > 0 ? (count * ab - a_sum * b_sum) / std::sqrt(va * vb) : 0;
}

}  // namespace

std::optional<EcgSignal> signalOfScroll(const EcgCurve& curve) {
  const auto n = static_cast<int>(curve.height_px.size());
  const int columns = curve.band.columns();
  // The smallest of the steps with the best match; one beat farther frames match equally well.
  std::vector<double> by_step;
  for (double step = 0; step <= columns / 10.0; step += 0.5)
    by_step.push_back(likeness(curve, 1, step));
  const double most = *std::max_element(by_step.begin(), by_step.end());
  std::size_t first = 0;
  while (by_step[first] < most - 0.02) ++first;
  while (first + 1 < by_step.size() && by_step[first + 1] > by_step[first]) ++first;
  double pace = 0.5 * static_cast<double>(first);
  if (!(pace > 0)) return std::nullopt;
  int lag = 1;
  for (double step = 0.25; 2 * lag < n && 2 * lag * pace < 0.4 * columns; step /= 2) {
    lag *= 2;
    double best = -2, at = pace;
    for (int i = -3; i <= 3; ++i) {
      const double own = pace + step * i / 1.5;
      if (const double like = likeness(curve, lag, lag * own); like > best) best = like, at = own;
    }
    pace = at;
  }
  EcgSignal out;
  out.kind = "scrolling";
  out.px_per_frame = pace;
  // Share of the possible improvement over a static trace.
  const double moved = likeness(curve, lag, lag * pace), still = likeness(curve, lag, 0);
  out.confidence =
      std::clamp((moved - std::max(0.0, still)) / (1 - std::clamp(still, 0.0, 0.9)), 0.0, 1.0);
  if (!(pace > 0)) return std::nullopt;
  // The right end is now: the last column that half of the frames have.
  std::vector<int> ends;
  for (const std::vector<float>& frame : curve.height_px)
    for (int x = columns - 1; x >= 0; --x)
      if (!std::isnan(frame[static_cast<std::size_t>(x)])) {
        ends.push_back(x);
        break;
      }
  if (ends.empty()) return std::nullopt;
  std::nth_element(ends.begin(), ends.begin() + static_cast<std::ptrdiff_t>(ends.size() / 2),
                   ends.end());
  const int end = ends[ends.size() / 2];
  out.first_frame = -end / pace;
  std::vector<std::vector<double>> seen(
      static_cast<std::size_t>(end + std::lround(pace * (n - 1)) + 1));
  for (int f = 0; f < n; ++f)
    for (int x = 0; x <= end; ++x) {
      const float h = curve.height_px[static_cast<std::size_t>(f)][static_cast<std::size_t>(x)];
      const auto at = static_cast<std::size_t>(x + std::lround(pace * f));
      if (!std::isnan(h) && at < seen.size()) seen[at].push_back(static_cast<double>(h));
    }
  for (std::vector<double>& values : seen) {
    if (values.empty()) {
      out.height_px.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    out.height_px.push_back(*middle);
  }
  return out;
}

}  // namespace echocine::echo
