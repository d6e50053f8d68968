#include "truth/valve_times.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echocine {

namespace {

// Shares of the stroke volume. Our choices: ejection begins fast, after ripples of interpolation,
// and ends slowly.
constexpr double kFull = 0.01, kEmpty = 0.002;

// From step `from` forwards or backwards, round the beat: where the volume first is on the other
// side of `level_ml`, linear between steps.
double crossing(std::span<const double> volume_ml, std::size_t from, int way, double level_ml) {
  const auto count = static_cast<int>(volume_ml.size());
  const auto at = [&](int i) {
    return volume_ml[static_cast<std::size_t>((i % count + count) % count)];
  };
  const auto start = static_cast<int>(from);
  const bool above = at(start) >= level_ml;
  for (int i = 1; i <= count; ++i) {
    const double now = at(start + way * i), before = at(start + way * (i - 1));
    if ((now >= level_ml) == above) continue;
    const double part = (level_ml - before) / (now - before);
    const double phase = (start + way * (i - 1 + part)) / count;
    return phase - std::floor(phase);
  }
  return 0;
}

// The phase at which flow begins, or ends if looked at backwards. Flow grows linearly at first, so
// the share of the stroke volume that has passed grows as the square of time, and its root, known
// at two shares, leads back to 0. step_ml: one share, negative if the volume falls.
double onset(std::span<const double> volume_ml, std::size_t from, int way, double step_ml) {
  const double first = crossing(volume_ml, from, way, volume_ml[from] + step_ml),
               second = crossing(volume_ml, from, way, volume_ml[from] + 2 * step_ml);
  const double phase = first - std::remainder(second - first, 1.0) / (std::numbers::sqrt2 - 1);
  return phase - std::floor(phase);
}

}  // namespace

std::optional<ValveTimes> valveTimes(std::span<const double> volume_ml) {
  if (volume_ml.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(volume_ml.begin(), volume_ml.end());
  const double stroke_ml = *most - *least;
  if (!(stroke_ml > 1e-3 * *most)) return std::nullopt;
  const auto full = static_cast<std::size_t>(most - volume_ml.begin()),
             empty = static_cast<std::size_t>(least - volume_ml.begin());
  return ValveTimes{onset(volume_ml, full, -1, -kFull * stroke_ml),
                    onset(volume_ml, full, 1, -kFull * stroke_ml),
                    crossing(volume_ml, empty, -1, *least + kEmpty * stroke_ml),
                    onset(volume_ml, empty, 1, kEmpty * stroke_ml)};
}

}  // namespace echocine
