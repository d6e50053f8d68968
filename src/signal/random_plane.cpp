#include "signal/random_plane.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "core/hash_random.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// Purposes of hashed numbers.
enum : std::uint64_t { kReal = 1, kImaginary = 2 };

std::vector<float> bellTaps(double deviation, int most) {
  const int reach = std::clamp(static_cast<int>(std::ceil(3 * deviation)), 0, most);
  std::vector<float> taps;
  for (int t = 0; t <= reach; ++t) taps.push_back(static_cast<float>(bell(t, deviation)));
  return taps;
}

// A plane that repeats, smeared along its lines (step 1) or across them (step samples).
void smear(std::vector<float>& plane, int lines, int samples, const std::vector<float>& taps,
           bool along) {
  if (taps.size() == 1) return;
  std::vector<float> out(plane.size());
  const int period = along ? samples : lines;
  for (int i = 0; i < lines; ++i)
    for (int t = 1 - static_cast<int>(taps.size()); t < static_cast<int>(taps.size()); ++t) {
      const float tap = taps[static_cast<std::size_t>(std::abs(t))];
      float* to = out.data() + static_cast<std::ptrdiff_t>(i) * samples;
      const int shift = (t % period + period) % period;
      const int from_line = along ? i : (i + shift) % lines,
                split = along ? samples - shift : samples;
      const float* from = plane.data() + static_cast<std::ptrdiff_t>(from_line) * samples;
      const int offset = along ? shift : 0;
      for (int k = 0; k < split; ++k) to[k] += tap * from[k + offset];
      for (int k = split; k < samples; ++k) to[k] += tap * from[k - split];
    }
  plane = std::move(out);
}

}  // namespace

RandomPlane::RandomPlane(int lines, int samples, const Grain& grain, std::uint64_t seed)
    : lines_(lines), samples_(samples), grain_(grain) {
  const std::vector<float> across = bellTaps(grain.lateral_lines, lines / 2 - 1),
                           along = bellTaps(grain.axial_samples, samples / 2 - 1);
  double power = 0;
  for (const auto& [part, field] : {std::pair(kReal, &real_), std::pair(kImaginary, &imaginary_)}) {
    field->resize(static_cast<std::size_t>(lines) * static_cast<std::size_t>(samples));
    for (std::size_t i = 0; i < field->size(); ++i)
      (*field)[i] =
          static_cast<float>(normalFromHashes(hashOf(seed, part, i, 0), hashOf(seed, part, i, 1)));
    smear(*field, lines, samples, along, true);
    smear(*field, lines, samples, across, false);
    for (const float value : *field)
      power += static_cast<double>(value) * static_cast<double>(value);
  }
  const auto scale = static_cast<float>(std::sqrt(static_cast<double>(real_.size()) / power));
  for (std::vector<float>* field : {&real_, &imaginary_})
    for (float& value : *field) value *= scale;
}

// A Gaussian of the amplitude with deviation s leaves amplitudes that correlate by exp(-d^2 / 4
// s^2).
double RandomPlane::correlation(PlaneShift a, PlaneShift b) const {
  const auto along = [](int from, int to, int period, double deviation) {
    const int straight = std::abs(to - from) % period;
    return bell(std::min(straight, period - straight), std::numbers::sqrt2 * deviation);
  };
  return along(a.lines, b.lines, lines_, grain_.lateral_lines) *
         along(a.samples, b.samples, samples_, grain_.axial_samples);
}

// A Gaussian of the amplitude with deviation s leaves intensities that correlate by
// exp(-d^2 / 2 s^2).
double grainAngle(const PointSpread& spread, double width_rad) {
  return std::max(spread.angle_rad, width_rad / kWidthAtHalf);
}

Grain grainOf(const Scene& scene, double width_rad) {
  const Probe& probe = scene.probe;
  const PointSpread spread(scene);
  Grain grain;
  if (probe.lines > 1)
    grain.lateral_lines = ScanGeometry(probe).linesAcross(grainAngle(spread, width_rad));
  grain.axial_samples = spread.axial_m / probe.sampleSpacing();
  return grain;
}

}  // namespace echocine
