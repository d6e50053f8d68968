#include "speckle/coherent_ratio.h"

#include <algorithm>
#include <cmath>

#include "speckle/point_spread.h"

namespace echocine {

namespace {

// Lines are summed in groups, piece by piece: a line finds what the previous one has read in the
// nearest cache. By time.
constexpr int kGroup = 4;
constexpr float kNothing = 1e-35f;  // power where no scatterer is in reach

float* floatsOf(std::vector<CacheLine>& lines) {
  return lines.front().floats;
}
std::size_t linesOf(std::ptrdiff_t floats) {
  return static_cast<std::size_t>(floats) / std::size(CacheLine{}.floats) + 1;
}
void setFloats(std::vector<CacheLine>& lines, std::ptrdiff_t count) {
  lines.assign(linesOf(count), {});
}

Floats8 roots(Floats8 a) {
  Floats8 out;
  for (std::size_t i = 0; i < kFloatLanes; ++i) out[i] = std::sqrt(a[i]);
  return out;
}

// Whole eights of samples, and an odd number of cache lines: rows a power of two apart would share
// few sets of the cache.
std::ptrdiff_t strideOf(int samples) {
  constexpr std::ptrdiff_t kLine = std::size(CacheLine{}.floats), kLanes = kFloatLanes;
  return (kNodeFloats * ((samples + kLanes - 1) / kLanes * kLanes) / kLine | 1) * kLine;
}

// A row reaches the splats of these lines to either side; splines are four rows wide.
int linesBeside(const GridSpacing& across, TapRange taps) {
  const int reach = std::max(-taps.first, taps.first + taps.count) + 2;
  return (reach * across.coarser + across.finer - 1) / across.finer + 1;
}

}  // namespace

CoherentRatio::CoherentRatio(const Probe& probe, const PointSpread& spread, const BeamView& view,
                             double smoothing_m)
    : lines_(probe.lines),
      samples_(probe.samples),
      grid_(probe, spread, view),
      lateral_(grid_, probe.samples),
      axial_(grid_, probe.samples),
      smoothing_(probe.samples, smoothing_m / kWidthAtHalf / probe.sampleSpacing()),
      length_(smoothing_.length()),
      stride_(strideOf(probe.samples)),
      slots_((kGroup / grid_.across().coarser + 1) * grid_.across().finer + lateral_.rows().count),
      beside_(linesBeside(grid_.across(), lateral_.rows())) {}

LineRange CoherentRatio::within(LineRange lines, int beside) const {
  return {std::max(lines.first - beside, 0), std::min(lines.end + beside, lines_)};
}

float* CoherentRatio::ratio(Rows& rows) const {
  return floatsOf(rows.ratio) + smoothing_.margin();
}

void CoherentRatio::start(LineRange lines, Rows& rows) const {
  const int first =
      std::min(lateral_.firstRow(lines.first), grid_.rowBefore(within(lines, beside_).first) - 1);
  const int most = std::max(lateral_.firstRow(kGroup - 1) + lateral_.rows().count,
                            grid_.rowBefore(kGroup + beside_) + grid_.across().finer + 4);
  grid_.start(first, most - std::min(lateral_.firstRow(0), grid_.rowBefore(-beside_) - 1) + 2,
              rows.grid);
  rows.smeared.resize(linesOf(slots_ * stride_));
  rows.next_smeared = lateral_.firstRow(lines.first);
  rows.sums.resize(linesOf(3 * kGroup * length_));
  setFloats(rows.ratio, 2 * (length_ + smoothing_.margin()));
  setFloats(rows.echoes, 3 * length_);
  setFloats(rows.field, 2 * length_);
}

// Smears it if it is not yet. A group takes its rows in ascending order, after all splats that
// reach them.
const float* CoherentRatio::smearedRow(int row, Rows& rows) const {
  float* const slot = floatsOf(rows.smeared) + (row % slots_ + slots_) % slots_ * stride_;
  if (row >= rows.next_smeared) {
    axial_.smear(grid_.row(rows.grid, row), samples_, slot);
    rows.next_smeared = row + 1;
  }
  return slot;
}

LineSums CoherentRatio::sumsOf(int line_of_group, Rows& rows) const {
  float* const real = floatsOf(rows.sums) + 3 * length_ * line_of_group;
  return {real, real + length_, real + 2 * length_};
}

void CoherentRatio::sumGroup(LineRange group, Rows& rows) const {
  const int first = lateral_.firstRow(group.first);
  const int end = lateral_.firstRow(group.end - 1) + lateral_.rows().count;
  grid_.clearUpTo(end - 1, rows.grid);
  thread_local std::vector<const float*> of_row;
  of_row.clear();
  for (int m = first; m < end; ++m) of_row.push_back(smearedRow(m, rows));
  for (std::ptrdiff_t from = 0; from < samples_; from += LateralTaps::kPiece)
    for (int i = group.first; i < group.end; ++i)
      lateral_.sum(of_row.data() + (lateral_.firstRow(i) - first), i, from,
                   std::min<std::ptrdiff_t>(from + LateralTaps::kPiece, samples_),
                   sumsOf(i - group.first, rows));
}

// The coherent part of a line's samples. Rounding may leave q a little over 1.
void CoherentRatio::shareOut(const CoherentEchoes& echoes, int line, const float* intensities,
                             float* rest) const {
  const std::size_t first = static_cast<std::size_t>(line) * static_cast<std::size_t>(samples_);
  float *real = rest + length_, *imaginary = real + length_;
  for (std::size_t k = 0; k < static_cast<std::size_t>(samples_); ++k) {
    const float part = echoes.intensity[first + k], of = intensities[k];
    const float q = of > 0 ? std::clamp(part / of, 0.0f, 1.0f) : 0;
    const float re = echoes.real[first + k], im = echoes.imaginary[first + k];
    const float size = std::sqrt(re * re + im * im);
    rest[k] = std::sqrt(1 - q);
    real[k] = std::sqrt(q) * (size > 0 ? re / size : 1);
    imaginary[k] = std::sqrt(q) * (size > 0 ? im / size : 0);
  }
}

// |g|^2 / w of a line, 1 where no scatterer is in reach.
void CoherentRatio::ratioOf(const LineSums& sums, float* ratio) const {
  const Floats8 one = Floats8{} + 1;
  for (int k = 0; k < samples_; k += kFloatLanes) {
    const Floats8 re = lanesAt(sums.real + k), im = lanesAt(sums.imaginary + k),
                  power = lanesAt(sums.power + k);
    const Floats8 of = (re * re + im * im) / (power > kNothing ? power : one);
    store(power > kNothing ? of : one, ratio + k);
  }
}

// The same by way of the field of unit mean power, with its coherent part.
void CoherentRatio::fieldOf(const LineSums& sums, const float* echoes, float* ratio,
                            float* field) const {
  const Floats8 one = Floats8{} + 1;
  for (int k = 0; k < samples_; k += kFloatLanes) {
    const Floats8 power = lanesAt(sums.power + k);
    const Ints8 some = power > kNothing;
    const Floats8 rest = (echoes ? lanesAt(echoes + k) : one) / roots(some ? power : one);
    Floats8 re = rest * lanesAt(sums.real + k), im = rest * lanesAt(sums.imaginary + k);
    if (echoes) {
      re += lanesAt(echoes + k + length_);
      im += lanesAt(echoes + k + 2 * length_);
    }
    re = some ? re : one;
    im = some ? im : Floats8{};
    store(re, field + k);
    store(im, field + k + length_);
    store(re * re + im * im, ratio + k);
  }
}

void CoherentRatio::keep(const float* unit, int line, const float* intensities,
                         EchoField& field) const {
  const std::size_t first = static_cast<std::size_t>(line) * static_cast<std::size_t>(samples_);
  for (std::size_t k = 0; k < static_cast<std::size_t>(samples_); ++k) {
    const float amplitude = std::sqrt(intensities[k]);
    field.mean[first + k] = intensities[k];
    field.real[first + k] = amplitude * unit[k];
    field.imaginary[first + k] = amplitude * unit[k + static_cast<std::size_t>(length_)];
  }
}

void CoherentRatio::finish(Rows& rows, float* intensities) const {
  float *of = ratio(rows), *smooth = of + length_ + smoothing_.margin();
  smoothing_.apply(of, rows.coarse, smooth);
  for (int k = 0; k < samples_; k += kFloatLanes) {
    const auto left = static_cast<std::size_t>(samples_ - k);
    storeSome(someLanesAt(intensities + k, left) * lanesAt(smooth + k), left, intensities + k);
  }
}

// A group of lines is finished as soon as the lines that reach it are added. Its intensities have
// then been read by all that need them.
void CoherentRatio::apply(const SplatLists& scattered, Rows& rows, std::span<float> intensities,
                          const CoherentEchoes& echoes, LineRange lines, EchoField* field) const {
  const auto plane = [&](int line) {
    return intensities.data() + static_cast<std::ptrdiff_t>(line) * samples_;
  };
  const bool keeps = field && !field->empty();
  start(lines, rows);
  int next = within(lines, beside_).first, next_root = std::max(next - 1, 0);
  for (int first = lines.first; first < lines.end; first += kGroup) {
    const LineRange group{first, std::min(first + kGroup, lines.end)};
    for (const int end = within(group, beside_).end; next < end; ++next) {
      for (; next_root < std::min(next + 2, lines_); ++next_root)
        grid_.setAmplitudes(next_root, plane(next_root), rows.grid);
      grid_.add(scattered.line(next), next, rows.grid);
    }
    sumGroup(group, rows);
    for (int i = group.first; i < group.end; ++i) {
      const LineSums sums = sumsOf(i - first, rows);
      if (!echoes.empty()) shareOut(echoes, i, plane(i), floatsOf(rows.echoes));
      if (keeps || !echoes.empty())
        fieldOf(sums, echoes.empty() ? nullptr : floatsOf(rows.echoes), ratio(rows),
                floatsOf(rows.field));
      else
        ratioOf(sums, ratio(rows));
      if (keeps) keep(floatsOf(rows.field), i, plane(i), *field);
      finish(rows, plane(i));
    }
  }
}

}  // namespace echocine
