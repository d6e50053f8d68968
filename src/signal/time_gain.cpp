#include "signal/time_gain.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

double gainAt(const std::vector<std::pair<double, double>>& table, double depth_m) {
  const auto above = std::upper_bound(table.begin(), table.end(), depth_m,
                                      [](double d, const auto& entry) { return d < entry.first; });
  if (above == table.begin()) return table.front().second;
  if (above == table.end()) return table.back().second;
  const auto& [d0, g0] = *(above - 1);
  const auto& [d1, g1] = *above;
  return g0 + (g1 - g0) * (depth_m - d0) / (d1 - d0);
}

}  // namespace

std::vector<float> timeGains(const std::vector<std::pair<double, double>>& table_m_db,
                             const Probe& probe) {
  const ScanGeometry geometry(probe);
  std::vector<float> gains;
  for (int k = 0; k < probe.samples; ++k)
    gains.push_back(
        static_cast<float>(intensityFromDecibels(gainAt(table_m_db, geometry.sampleDepth(k)))));
  return gains;
}

std::vector<float> gainsAgainst(std::span<const double> losses) {
  std::vector<float> gains;
  for (const double loss : losses) gains.push_back(static_cast<float>(1 / loss));
  return gains;
}

std::vector<float> nominalGains(double attenuation_np_per_m, const Probe& probe) {
  constexpr double kMost = 1e20;  // of intensity: within floats
  const ScanGeometry geometry(probe);
  std::vector<float> gains;
  for (int k = 0; k < probe.samples; ++k) {
    const double gain = std::exp(4 * attenuation_np_per_m * geometry.sampleDepth(k));
    gains.push_back(static_cast<float>(std::min(gain, kMost)));
  }
  return gains;
}

void applyTimeGains(std::span<const float> gains, std::span<float> plane) {
  for (std::size_t line = 0; line + gains.size() <= plane.size(); line += gains.size())
    for (std::size_t k = 0; k < gains.size(); ++k) plane[line + k] *= gains[k];
}

}  // namespace echocine
