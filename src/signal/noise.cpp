#include "signal/noise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>

#include "core/hash_random.h"
#include "core/parallel.h"
#include "core/units.h"
#include "scene/scan_geometry.h"
#include "speckle/point_spread.h"

namespace echocine {

namespace {

// A random plane is no smaller: shifted parts of it then hardly ever meet. Our choice.
constexpr int kLeastLines = 128, kLeastSamples = 512;

// Purposes of hashed numbers.
enum : std::uint64_t { kReal = 1, kImaginary = 2, kLineShift = 3, kSampleShift = 4, kClutter = 5 };

// White as a float that leaves room for products.
float heldWhite(double white) {
  return static_cast<float>(std::min(white, 1e30));
}

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
    : lines_(lines), samples_(samples) {
  const std::vector<float> across = bellTaps(grain.lateral_lines, lines / 2 - 1),
                           along = bellTaps(grain.axial_samples, samples / 2 - 1),
                           smoothing = bellTaps(grain.smoothing_samples, samples / 2 - 1);
  values_.resize(static_cast<std::size_t>(lines) * static_cast<std::size_t>(samples));
  for (const std::uint64_t part : {kReal, kImaginary}) {
    std::vector<float> field(values_.size());
    for (std::size_t i = 0; i < field.size(); ++i)
      field[i] =
          static_cast<float>(normalFromHashes(hashOf(seed, part, i, 0), hashOf(seed, part, i, 1)));
    smear(field, lines, samples, along, true);
    smear(field, lines, samples, across, false);
    for (std::size_t i = 0; i < field.size(); ++i) values_[i] += field[i] * field[i];
  }
  smear(values_, lines, samples, smoothing, true);
  double sum = 0;
  for (const float value : values_) sum += static_cast<double>(value);
  const auto scale = static_cast<float>(static_cast<double>(values_.size()) / sum);
  for (float& value : values_) value *= scale;
}

Grain grainOf(const Scene& scene, double width_rad) {
  const Probe& probe = scene.probe;
  const PointSpread spread(probe, scene.signal.pulse_cycles);
  // A bell of amplitude with deviation s leaves intensities that correlate by exp(-d^2 / 2 s^2).
  const double angle_rad = std::max(spread.angle_rad, width_rad / kWidthAtHalf);
  Grain grain;
  if (probe.lines > 1) grain.lateral_lines = ScanGeometry(probe).linesAcross(angle_rad);
  grain.axial_samples = spread.axial_m / probe.sampleSpacing();
  grain.smoothing_samples = scene.speckle.smoothing_m / kWidthAtHalf / probe.sampleSpacing();
  return grain;
}

ReceiverNoise::ReceiverNoise(const Scene& scene, std::span<const float> gains)
    : lines_(scene.probe.lines),
      samples_(scene.probe.samples),
      seed_(scene.artefacts.noise_seed),
      random_(std::max(lines_, kLeastLines), std::max(samples_, kLeastSamples), grainOf(scene),
              hashOf(seed_)) {
  const double level = intensityFromDecibels(scene.artefacts.noise_db);
  const double most =
      gains.empty() ? 1 : static_cast<double>(*std::max_element(gains.begin(), gains.end()));
  for (std::size_t k = 0; k < static_cast<std::size_t>(samples_); ++k)
    levels_.push_back(static_cast<float>(
        level * (gains.empty() || !(most > 0) ? 1 : static_cast<double>(gains[k]) / most)));
}

void ReceiverNoise::add(double white, double time_s, std::span<float> plane) const {
  const std::uint64_t instant = hashOf(seed_, std::bit_cast<std::uint64_t>(time_s + 0.0));
  const auto first_line =
      static_cast<int>(hashOf(instant, kLineShift) % static_cast<std::uint64_t>(random_.lines()));
  const auto first = static_cast<int>(hashOf(instant, kSampleShift) %
                                      static_cast<std::uint64_t>(random_.samples()));
  const float scale = heldWhite(white);
  for (int i = 0; i < lines_; ++i) {
    const float* from = random_.line((i + first_line) % random_.lines());
    float* to = plane.data() + static_cast<std::ptrdiff_t>(i) * samples_;
    const int split = std::min(samples_, random_.samples() - first);
    for (int k = 0; k < split; ++k)
      to[k] += scale * levels_[static_cast<std::size_t>(k)] * from[k + first];
    for (int k = split; k < samples_; ++k)
      to[k] += scale * levels_[static_cast<std::size_t>(k)] * from[k - split];
  }
}

NearFieldClutter::NearFieldClutter(const Scene& scene)
    : lines_(scene.probe.lines),
      samples_(scene.probe.samples),
      random_(std::max(lines_, kLeastLines), std::max(samples_, kLeastSamples),
              grainOf(scene, scene.artefacts.clutter_width_rad),
              hashOf(scene.artefacts.clutter_seed, kClutter)) {
  constexpr double kLeast = 1e-6;
  const double level = intensityFromDecibels(scene.artefacts.clutter_db);
  const ScanGeometry geometry(scene.probe);
  for (int k = 0; k < samples_; ++k) {
    const double falls = std::exp(-geometry.sampleDepth(k) / scene.artefacts.clutter_length_m);
    if (falls < kLeast) break;
    levels_.push_back(static_cast<float>(level * falls));
  }
}

void NearFieldClutter::add(double white, std::span<float> plane) const {
  const float scale = heldWhite(white);
  for (int i = 0; i < lines_; ++i) {
    const float* from = random_.line(i);
    float* to = plane.data() + static_cast<std::ptrdiff_t>(i) * samples_;
    for (std::size_t k = 0; k < levels_.size(); ++k) to[k] += scale * levels_[k] * from[k];
  }
}

}  // namespace echocine
