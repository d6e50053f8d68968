#include "signal/noise.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "core/hash_random.h"
#include "core/lanes.h"
#include "core/normal_lanes.h"
#include "core/units.h"
#include "scene/scan_geometry.h"
#include "signal/harmonic.h"
#include "speckle/point_spread.h"

namespace echocine {

namespace {

constexpr std::uint64_t kClutter = 5;  // purpose of hashed numbers
constexpr double kAlike = 0.01;  // correlation of two fields up to which they count as independent
constexpr int kAttempts = 32;
constexpr int kLanes = static_cast<int>(kFloatLanes), kChains = 4, kStep = kChains * kLanes;
// Longer pulses are filtered from white numbers that are several samples apart, and at least this
// part of sigma: the power then varies by under 1e-6.
constexpr double kLeastNodes = 1.3;

std::vector<float> rootsOf(const std::vector<float>& levels) {
  std::vector<float> out;
  for (const float level : levels) out.push_back(std::sqrt(level));
  return out;
}

int samplesPerNode(double deviation) {
  int out = 1;
  while (deviation >= kLeastNodes * kLanes && deviation >= 2 * kLeastNodes * out) out *= 2;
  return out;
}

}  // namespace

float heldWhite(double white) {
  return static_cast<float>(std::min(white, 1e30));
}

std::vector<float> noiseLevels(const Scene& scene, std::span<const float> gains) {
  const double level = intensityFromDecibels(scene.artefacts.noise_db);
  const double most =
      gains.empty() ? 1 : static_cast<double>(*std::max_element(gains.begin(), gains.end()));
  std::vector<float> levels;
  for (std::size_t k = 0; k < static_cast<std::size_t>(scene.probe.samples); ++k)
    levels.push_back(static_cast<float>(
        level * (gains.empty() || !(most > 0) ? 1 : static_cast<double>(gains[k]) / most)));
  return levels;
}

std::vector<float> clutterLevels(const Scene& scene, bool harmonic, double window_db) {
  constexpr double kLeast = 1e-6;
  const double level = intensityFromDecibels(scene.artefacts.clutter_db + window_db);
  const ScanGeometry geometry(scene.probe);
  std::vector<float> levels;
  for (int k = 0; k < scene.probe.samples; ++k) {
    const double falls = std::exp(-geometry.sampleDepth(k) / scene.artefacts.clutter_length_m);
    if (falls < kLeast) break;
    levels.push_back(static_cast<float>(level * falls));
  }
  if (!harmonic) return levels;
  const std::vector<float> built = buildUps(scene.probe), gains = gainsOfBuildUp(scene.probe);
  for (std::size_t k = 0; k < levels.size(); ++k) levels[k] *= built[k] * gains[k];
  return levels;
}

ReceiverNoise::ReceiverNoise(const Scene& scene, std::span<const float> gains)
    : samples_(scene.probe.samples),
      seed_(scene.artefacts.noise_seed),
      amplitudes_(rootsOf(noiseLevels(scene, gains))) {
  const double samples = grainOf(scene).axial_samples;
  per_node_ = samplesPerNode(samples);
  const double deviation = samples / per_node_;
  reach_ = static_cast<int>(std::ceil(3 * deviation));
  for (int phase = 0; phase < per_node_; ++phase) {
    double power = 0;
    const auto at = [&](int t) {
      return bell(t - static_cast<double>(phase) / per_node_, deviation);
    };
    for (int t = -reach_; t <= reach_ + 1; ++t) power += at(t) * at(t);
    for (int t = -reach_; t <= reach_ + 1; ++t)
      taps_.push_back(static_cast<float>(at(t) / std::sqrt(power)));
  }
}

// White numbers of each sample. Four groups of lanes at once do not wait for each other.
void ReceiverNoise::filterEach(const float* from, float* to) const {
  for (int k = 0; k < samples_; k += kStep) {
    Floats8 sums[kChains]{};
    for (std::size_t t = 0; t < taps_.size(); ++t)
      for (int c = 0; c < kChains; ++c) sums[c] += taps_[t] * lanesAt(from + k + t + c * kLanes);
    for (int c = 0; c < kChains; ++c) store(sums[c], to + k + c * kLanes);
  }
}

// White numbers of nodes. The samples between two nodes are a whole number of groups of lanes.
void ReceiverNoise::filterBetween(const float* from, float* to) const {
  const int taps = 2 * reach_ + 2;
  for (int k = 0; k < samples_; k += kLanes) {
    const int node = k / per_node_, phase = k % per_node_;
    Floats8 sum{};
    for (int t = 0; t < taps; ++t) {
      Floats8 h;
      for (int i = 0; i < kLanes; ++i)
        h[i] = taps_[static_cast<std::size_t>((phase + i) * taps + t)];
      sum += h * from[node + t];
    }
    store(sum, to + k);
  }
}

void ReceiverNoise::add(double white, double time_s, int line, float* real,
                        float* imaginary) const {
  const std::uint64_t key = hashOf(seed_, std::bit_cast<std::uint64_t>(time_s + 0.0), line);
  const int steps = (samples_ + kStep - 1) / kStep;
  const int nodes = steps * kStep / per_node_ + 2 * reach_ + 2;
  thread_local std::vector<float> white_real, white_imaginary, filtered;
  white_real.resize(static_cast<std::size_t>(nodes + kLanes));
  white_imaginary.resize(white_real.size());
  filtered.resize(static_cast<std::size_t>(steps * kStep));
  for (int n = 0; n < nodes; n += kLanes) {
    const ComplexLanes z = complexNormals(key, static_cast<std::uint32_t>(n));
    store(z.real, white_real.data() + n);
    store(z.imaginary, white_imaginary.data() + n);
  }
  const float scale = std::sqrt(heldWhite(white));
  for (const auto& [from, to] :
       {std::pair(white_real.data(), real), std::pair(white_imaginary.data(), imaginary)}) {
    per_node_ == 1 ? filterEach(from, filtered.data()) : filterBetween(from, filtered.data());
    for (std::size_t k = 0; k < amplitudes_.size(); ++k)
      to[k] += scale * amplitudes_[k] * filtered[k];
  }
}

NearFieldClutter::NearFieldClutter(const Scene& scene, bool harmonic, double window_db)
    : amplitudes_(rootsOf(clutterLevels(scene, harmonic, window_db))),
      renewed_s_(scene.artefacts.clutter_time_s),
      seed_(hashOf(scene.artefacts.clutter_seed, kClutter)),
      // The plane repeats: over a full turn, after as many lines as there are.
      random_(scene.probe.isFullTurn() ? scene.probe.lines : std::max(scene.probe.lines, 128),
              std::max(scene.probe.samples, 512), grainOf(scene, scene.artefacts.clutter_width_rad),
              seed_),
      middle_line_(0.5f * static_cast<float>(scene.probe.lines - 1)) {
  if (!scene.probe.isSector() || scene.probe.face_radius_m > 0) return;
  unlike_ = static_cast<float>(1 - random_.correlation({}, {1, 0}));
  const PointSpread spread(scene);
  const ScanGeometry geometry(scene.probe);
  const double over_cell = grainAngle(spread, scene.artefacts.clutter_width_rad) / spread.angle_rad;
  for (std::size_t k = 0; k < amplitudes_.size(); ++k) {
    const double part = spread.receiving(geometry.sampleDepth(static_cast<int>(k))) * over_cell;
    if (part >= 1) break;
    closer_.push_back(static_cast<float>(part));
  }
}

// Later attempts go on across the end of the samples, where the plane repeats.
PlaneShift NearFieldClutter::drawn(std::int64_t number, int attempt) const {
  const auto below = [&](int axis, int count) {
    return static_cast<int>(hashOf(seed_, number, axis + 2 * attempt) %
                            static_cast<std::uint64_t>(count));
  };
  const int spare = random_.samples() - static_cast<int>(amplitudes_.size()) + 1;
  return {below(0, random_.lines()), below(1, attempt == 0 ? spare : random_.samples())};
}

// Fields after the first are the plane at hashed offsets. Two fields in succession must not
// resemble each other, because their blend would be brighter: an odd one is drawn again until it
// resembles neither neighbour.
PlaneShift NearFieldClutter::shiftOf(std::int64_t number) const {
  if (number == 0) return {};
  if (number % 2 == 0) return drawn(number, 0);
  const PlaneShift before = number == 1 ? PlaneShift{} : drawn(number - 1, 0),
                   after = number == -1 ? PlaneShift{} : drawn(number + 1, 0);
  PlaneShift best;
  double least = 2;
  for (int attempt = 0; attempt < kAttempts && least > kAlike; ++attempt) {
    const PlaneShift shift = drawn(number, attempt);
    const double alike =
        std::max(random_.correlation(shift, before), random_.correlation(shift, after));
    if (alike >= least) continue;
    least = alike;
    best = shift;
  }
  return best;
}

void NearFieldClutter::addField(float scale, std::int64_t number, int line, float* real,
                                float* imaginary) const {
  const PlaneShift shift = shiftOf(number);
  addWidened(scale, shift, line, real, imaginary);
  const int from = (line + shift.lines) % random_.lines();
  const float *re = random_.real(from), *im = random_.imaginary(from);
  const auto first = static_cast<std::size_t>(shift.samples),
             split =
                 std::min(amplitudes_.size(), static_cast<std::size_t>(random_.samples()) - first);
  const auto addRun = [&](std::size_t begin, std::size_t end, const float* r, const float* i) {
    for (std::size_t k = std::max(begin, closer_.size()); k < end; ++k) {
      real[k] += scale * amplitudes_[k] * r[k - begin];
      imaginary[k] += scale * amplitudes_[k] * i[k - begin];
    }
  };
  addRun(0, split, re + first, im + first);
  addRun(split, amplitudes_.size(), re, im);
}

// Between two lines of the plane, with the power of one of them: 1 / sqrt(1 - 2 y) to 1 %, with y =
// part (1 - part) (1 - correlation) of up to 1/4.
void NearFieldClutter::addWidened(float scale, PlaneShift shift, int line, float* real,
                                  float* imaginary) const {
  const int lines = random_.lines(), samples = random_.samples();
  const auto once = [](int at, int period) { return at < period ? at : at - period; };
  for (std::size_t k = 0; k < closer_.size(); ++k) {
    const float at = middle_line_ + (static_cast<float>(line) - middle_line_) * closer_[k];
    const auto before = static_cast<int>(at);
    const float part = at - static_cast<float>(before), y = part * (1 - part) * unlike_;
    const int from = once(before + shift.lines, lines), next = once(from + 1, lines),
              sample = once(static_cast<int>(k) + shift.samples, samples);
    const float of = scale * amplitudes_[k] * (1 + y * (1 + 1.5f * y));
    const float first = of * (1 - part), second = of * part;
    real[k] += first * random_.real(from)[sample] + second * random_.real(next)[sample];
    imaginary[k] +=
        first * random_.imaginary(from)[sample] + second * random_.imaginary(next)[sample];
  }
}

void NearFieldClutter::add(double white, double time_s, int line, float* real,
                           float* imaginary) const {
  const float scale = std::sqrt(heldWhite(white));
  if (!(renewed_s_ > 0)) return addField(scale, 0, line, real, imaginary);
  const double renewals = time_s / renewed_s_, whole = std::floor(renewals);
  // From 2^52 on a double has no fraction: each instant then has a field of its own, by its bits.
  if (!(std::abs(renewals) < 0x1p52))
    return addField(scale, std::bit_cast<std::int64_t>(renewals) / 2, line, real, imaginary);
  const double turn_rad = 0.5 * std::numbers::pi * (renewals - whole);
  const auto number = static_cast<std::int64_t>(whole);
  addField(scale * static_cast<float>(std::cos(turn_rad)), number, line, real, imaginary);
  addField(scale * static_cast<float>(std::sin(turn_rad)), number + 1, line, real, imaginary);
}

}  // namespace echocine
