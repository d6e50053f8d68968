#include "signal/harmonic.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

constexpr double kMostGain_db = 12;

}  // namespace

double harmonicBuildUp(const Probe& probe, double path_m) {
  const double sent_m = 2 * ScanGeometry(probe).wavelength();
  const double a = 0.45 * probe.aperture_m * probe.aperture_m / (1.27 * sent_m * probe.focus_m);
  const double share =
      1 - std::asinh(a * (1 - path_m / probe.focus_m)) / std::asinh(a);  // I(z) / I(F)
  return share * share;
}

std::vector<float> buildUps(const Probe& probe) {
  const ScanGeometry geometry(probe);
  std::vector<float> factors;
  for (int k = 0; k < probe.samples; ++k)
    factors.push_back(static_cast<float>(harmonicBuildUp(probe, geometry.sampleDepth(k))));
  return factors;
}

std::vector<float> gainsOfBuildUp(const Probe& probe) {
  const auto most = static_cast<float>(intensityFromDecibels(kMostGain_db));
  std::vector<float> gains = buildUps(probe);
  for (float& gain : gains) gain = gain * most > 1 ? 1 / gain : most;
  return gains;
}

}  // namespace echocine
