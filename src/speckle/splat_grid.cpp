#include "speckle/splat_grid.h"

#include <algorithm>
#include <cmath>

#include "scene/scan_geometry.h"
#include "speckle/point_spread.h"

namespace echocine {

namespace {

// Least sigma in spacings. Our choice: the errors of spline_taps.h, and those of the axial power.
constexpr double kLeastNodes = 1.3, kLeastRows = 1.1, kLeastRowsOnLines = 0.9;
constexpr int kMostNodesPerSample = 4, kMostRowsPerLine = 8;
// Narrower pulses are widened to this: a sample stands for its interval. Our choice.
constexpr double kLeastSamples = 0.325;
constexpr double kMostSectors = 2;                              // of sigma: wider is nearly uniform
constexpr int kMostLinesPerRow = 8, kMostSamplesPerNode = 256;  // bounds of the tables of taps
constexpr double kFloor = 0.8;  // of sigma in rows, near a linear probe's face
constexpr int kStepBits = 6;
static_assert(1 << kStepBits == kSplineSteps);
constexpr std::ptrdiff_t kLineFloats = std::size(CacheLine{}.floats);

GridSpacing axialSpacing(double samples) {
  GridSpacing out;
  while (samples * out.finer < kLeastNodes && out.finer < kMostNodesPerSample) out.finer *= 2;
  while (samples >= 2 * kLeastNodes * out.coarser && out.coarser < kMostSamplesPerNode)
    out.coarser *= 2;
  return out;
}

GridSpacing lateralSpacing(double lines) {
  GridSpacing out;
  if (lines < kLeastRowsOnLines)
    out.finer = std::min(static_cast<int>(std::ceil(kLeastRows / lines)), kMostRowsPerLine);
  else if (lines >= 1.5 * kLeastRows && lines < 2 * kLeastRows)
    out = {2, 3};
  else
    out.coarser = std::max(static_cast<int>(lines / kLeastRows), 1);
  return out;
}

std::ptrdiff_t roundedUp(std::ptrdiff_t count, std::ptrdiff_t to) {
  return (count + to - 1) / to * to;
}

int floorDivided(int a, int b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

bool isEven(const std::vector<double>& deviations) {
  const auto [least, most] = std::minmax_element(deviations.begin(), deviations.end());
  return *most - *least < 1e-6 * *most;
}

Floats8 inBothHalves(Floats4 a) {
  return __builtin_shufflevector(a, a, 0, 1, 2, 3, 0, 1, 2, 3);
}

void setFour(float* to, double value) {
  std::fill(to, to + kNodeFloats, static_cast<float>(value));
}

}  // namespace

SplatGrid::SplatGrid(const Probe& probe, const PointSpread& spread, const BeamView& view)
    : lines_(probe.lines),
      samples_(probe.samples),
      axial_samples_(std::max(spread.axial_m / probe.sampleSpacing(), kLeastSamples)),
      along_(axialSpacing(axial_samples_)) {
  while (1 << up_ < along_.finer) ++up_;
  while (1 << down_ < along_.coarser) ++down_;
  constexpr int kBeyond = kFloatLanes - 1;  // samples that sums of eight read
  nodes_ = roundedUp(static_cast<std::ptrdiff_t>(along_.nodes(samples_ + kBeyond)) + 2, 8);
  const ScanGeometry geometry(probe);
  for (int k = 0; k < samples_; ++k) widenings_.push_back(spread.widening(geometry.sampleDepth(k)));
  const TapRange taps = tapRange(along_.nodes(mostAxialSamples()), 0, 1);
  margin_ = roundedUp(std::max(taps.count + taps.first, -taps.first) + 4, 16);
  // An odd number of cache lines: rows a power of two apart would share few sets of the cache.
  stride_ = (kNodeFloats * (nodes_ + 2 * margin_) / kLineFloats | 1) * kLineFloats;
  std::vector<double> lines;
  for (int k = 0; k < samples_; ++k)
    lines.push_back(std::min(view.lateralLines(geometry.sampleDepth(k)), kMostSectors * lines_));
  setAcross(std::move(lines));
  setWeights();
}

double SplatGrid::mostAxialSamples() const {
  return axial_samples_ * *std::max_element(widenings_.begin(), widenings_.end());
}

// lines: sigma across the lines, by sample.
void SplatGrid::setAcross(std::vector<double> lines) {
  even_ = isEven(lines);
  across_ = lateralSpacing(lines[lines.size() / 4]);
  if (!even_) across_.coarser = std::min(across_.coarser, kMostLinesPerRow);
  for (double& deviation : lines) deviation = std::max(across_.nodes(deviation), kFloor);
  even_ = isEven(lines);  // also where all are that narrow
  for (std::size_t k = 0; k < (even_ ? 1 : lines.size()); ++k) {
    const auto q = static_cast<float>(std::exp(-1 / (lines[k] * lines[k] - 1.0 / 3)));
    couplings_.push_back(Floats4{0, 0, q, q * q});
  }
  deviations_ = std::move(lines);
}

void SplatGrid::setWeights() {
  axial_.resize(kSplineSteps);
  lateral_.resize(2 * kSplineSteps);
  for (std::size_t step = 0; step < kSplineSteps; ++step) {
    const std::array<double, 4> b = splineWeights((static_cast<double>(step) + 0.5) / kSplineSteps);
    float *by_row = lateral_[2 * step].floats, *coupled = lateral_[2 * step + 1].floats;
    for (std::size_t m = 0; m < 4; ++m) {
      setFour(axial_[step].floats + 4 * m, b[m]);
      setFour(by_row + 4 * m, b[m]);
      by_row[4 * m + 2] = static_cast<float>(b[m] * b[m]);
      by_row[4 * m + 3] = m < 3 ? static_cast<float>(2 * b[m] * b[m + 1]) : 0;
    }
    coupled[4 + 2] = static_cast<float>(2 * b[0] * b[2]);
    coupled[4 + 3] = static_cast<float>(2 * b[0] * b[3]);
    coupled[8 + 2] = static_cast<float>(2 * b[1] * b[3]);
    if (!even_) continue;
    for (std::size_t i = 4; i < 12; ++i) by_row[i] += couplings_[0][i % 4] * coupled[i];
    const CacheLine all = lateral_[2 * step];
    for (std::size_t m = 0; m < 4; ++m)
      store(inBothHalves(fourAt(all.floats + 4 * m)),
            lateral_[2 * step + m / 2].floats + m % 2 * kFloatLanes);
  }
}

// By lines from the middle of line 0.
int SplatGrid::rowBefore(int line) const {
  return floorDivided((2 * line - 1) * across_.finer, 2 * across_.coarser);
}

float* SplatGrid::row(Rows& rows, int number) const {
  const std::ptrdiff_t slots =
      static_cast<std::ptrdiff_t>(rows.ring.size()) * kLineFloats / stride_;
  const std::ptrdiff_t slot = (number % slots + slots) % slots;
  float* const first = rows.ring.front().floats;
  return first + slot * stride_ + margin_ * kNodeFloats;
}

void SplatGrid::start(int first_row, int rows_in_use, Rows& rows) const {
  rows.ring.resize(
      static_cast<std::size_t>((rows_in_use + 8 + 2 * across_.finer) * stride_ / kLineFloats));
  rows.amplitudes.resize(static_cast<std::size_t>(4 * (samples_ + 2)));
  rows.next_row = first_row;
}

void SplatGrid::clearUpTo(int row_number, Rows& rows) const {
  for (; rows.next_row <= row_number; ++rows.next_row) {
    float* from = row(rows, rows.next_row) - margin_ * kNodeFloats;
    std::fill(from, from + stride_, 0.0f);
  }
}

float* SplatGrid::amplitudesOf(Rows& rows, int line) const {
  return rows.amplitudes.data() + (std::clamp(line, 0, lines_ - 1) % 4) * (samples_ + 2);
}

void SplatGrid::setAmplitudes(int line, const float* intensities, Rows& rows) const {
  float* to = amplitudesOf(rows, line);
  for (int k = 0; k < samples_; ++k) to[k + 1] = std::sqrt(intensities[k]);
  to[0] = to[1];
  to[samples_ + 1] = to[samples_];
}

namespace {

constexpr int kHalf = kSplineSteps / 2;
constexpr float kPerStep = 1.0f / kSplineSteps;

// By step between two samples or lines: its place in parts of their distance.
struct StepParts {
  float of[kSplineSteps];
  constexpr StepParts() : of{} {
    for (int step = 0; step < kSplineSteps; ++step)
      of[step] = (static_cast<float>(step) + 0.5f) * kPerStep;
  }
};
constexpr StepParts kParts;

// The picture's amplitude at a splat, between four samples of three neighbouring lines.
inline float amplitudeAt(const Splat& splat, const float* const (&amplitudes)[3]) {
  const auto along = static_cast<unsigned>(splat.sampleAt() + kHalf),
             beside = static_cast<unsigned>(splat.lineStep() + kHalf);
  const float t = kParts.of[along % kSplineSteps], s = kParts.of[beside % kSplineSteps];
  const float *one = amplitudes[beside / kSplineSteps] + along / kSplineSteps,
              *two = amplitudes[beside / kSplineSteps + 1] + along / kSplineSteps;
  const float a1 = one[0] + t * (one[1] - one[0]), a2 = two[0] + t * (two[1] - two[0]);
  return a1 + s * (a2 - a1);
}

}  // namespace

namespace {

inline Floats4 valueOf(const Splat& splat, float amplitude) {
  const float power = amplitude * amplitude;
  return Floats4{splat.real, splat.imaginary, splat.square, splat.square} *
         Floats4{amplitude, amplitude, power, power};
}

// A node's factors of one of the four rows, twice. q: the couplings at the splat, unless even.
template <bool even>
inline Floats8 factorsOf(const CacheLine* lateral, int row, Floats4 q) {
  if (even) return lanesAt(lateral[row / 2].floats + row % 2 * 8);
  const Floats4 own = fourAt(lateral->floats + 4 * row);
  const bool coupled = row == 1 || row == 2;
  return inBothHalves(coupled ? own + q * fourAt(lateral[1].floats + 4 * row) : own);
}

}  // namespace

// The rows of a line's splats, by step between two lines.
struct SplatGrid::LineSteps {
  int row[kSplineSteps], step[kSplineSteps];  // from the first row on; between two rows

  LineSteps(const GridSpacing& across, int line, int first_row) {
    const auto per_step = static_cast<float>(across.nodes(kPerStep));
    const float lowest = static_cast<float>(across.nodes(line - 0.5) - first_row) + 0.5f * per_step;
    for (int i = 0; i < kSplineSteps; ++i) {
      const float at = lowest + per_step * static_cast<float>(i);
      row[i] = static_cast<int>(at);
      step[i] = static_cast<int>(kSplineSteps * (at - static_cast<float>(row[i])));
    }
  }
};

void SplatGrid::add(std::span<const Splat> splats, int line, Rows& rows) const {
  even_ ? addAll<true>(splats, line, rows) : addAll<false>(splats, line, rows);
}

template <bool even>
void SplatGrid::addAll(std::span<const Splat> splats, int line, Rows& rows) const {
  constexpr std::ptrdiff_t kAhead = 32;  // our choice, by time
  const int first = rowBefore(line), reached = across_.finer + 4;
  clearUpTo(first - 1 + reached, rows);
  float* of_row[kMostRowsPerLine + 6];
  for (int m = 0; m <= reached; ++m) of_row[m] = row(rows, first - 1 + m);
  const LineSteps steps(across_, line, first);
  const float* amplitudes[3];
  for (int i = 0; i < 3; ++i) amplitudes[i] = amplitudesOf(rows, line - 1 + i);
  // Copies: a store of floats might change what the members point to.
  const CacheLine *const axials = axial_.data(), *const laterals = lateral_.data();
  const Floats4* const couplings = couplings_.data();
  const int up = up_, down = down_ + 1;
  for (const Splat& stored : splats) {
    __builtin_prefetch(&stored + kAhead);
    const Splat splat = stored;
    const Floats8 value = inBothHalves(valueOf(splat, amplitudeAt(splat, amplitudes)));
    const int node = ((2 * (splat.sampleAt() - kHalf) + 1) << up) >> down;
    const float* axial = axials[node & (kSplineSteps - 1)].floats;
    const Floats8 near = lanesAt(axial), far = lanesAt(axial + 8);
    const auto line_step = static_cast<unsigned>(splat.lineStep());
    const int m = steps.row[line_step];
    const CacheLine* lateral = laterals + 2 * steps.step[line_step];
    const Floats4 q = even ? Floats4{} : couplings[splat.sample()];
    const std::ptrdiff_t from = kNodeFloats * ((node >> kStepBits) - 1);
    const auto addRow = [&](int r, Floats8 by) {
      const Floats8 both = value * by;
      float* to = of_row[m + r] + from;
      store(lanesAt(to) + both * near, to);
      store(lanesAt(to + 8) + both * far, to + 8);
    };
    for (int r = 0; r < 4; ++r) addRow(r, factorsOf<even>(lateral, r, q));
  }
}

}  // namespace echocine
