#include "truth/valve_times.h"

#include <algorithm>
#include <cmath>

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

}  // namespace

std::optional<ValveTimes> valveTimes(std::span<const double> volume_ml) {
  if (volume_ml.empty()) return std::nullopt;
  const auto [least, most] = std::minmax_element(volume_ml.begin(), volume_ml.end());
  const double stroke_ml = *most - *least;
  if (!(stroke_ml > 1e-3 * *most)) return std::nullopt;
  const auto full = static_cast<std::size_t>(most - volume_ml.begin()),
             empty = static_cast<std::size_t>(least - volume_ml.begin());
  const double full_ml = *most - kFull * stroke_ml, empty_ml = *least + kEmpty * stroke_ml;
  return ValveTimes{crossing(volume_ml, full, -1, full_ml), crossing(volume_ml, full, 1, full_ml),
                    crossing(volume_ml, empty, -1, empty_ml),
                    crossing(volume_ml, empty, 1, empty_ml)};
}

}  // namespace echocine
