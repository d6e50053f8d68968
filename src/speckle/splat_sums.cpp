#include "speckle/splat_sums.h"

#include <algorithm>
#include <cmath>

#include "scene/scan_geometry.h"
#include "speckle/point_spread.h"

namespace echocine {

namespace {

constexpr double kRowsPerDeviation = 2;  // at half the depth. Our choice: see the README
constexpr int kMostRowsPerLine = 8;
constexpr double kLeastRows = 0.5;     // rows. Near a linear probe's face cells vanish
constexpr int kFours = 4;              // lanes that axial taps are a multiple of
constexpr std::ptrdiff_t kPlanes = 3;  // of a row: real, imaginary, squares
constexpr std::ptrdiff_t kCacheLine = std::size(CacheLine{}.floats);

// What is summed at once: chains that do not wait for each other.
constexpr std::ptrdiff_t kSumLanes = kFloatLanes, kSumChains = 4, kSumStep = kSumChains * kSumLanes;
// Rows are summed piece by piece: what one line has read the next finds in the nearest cache.
constexpr std::ptrdiff_t kPiece = 64;

std::ptrdiff_t roundedUp(std::ptrdiff_t floats, std::ptrdiff_t of) {
  return (floats + of - 1) / of * of;
}

Floats8 lanesOf(const float* from, Floats8) {
  return lanesAt(from);
}
Floats4 lanesOf(const float* from, Floats4) {
  Floats4 lanes;
  std::memcpy(&lanes, from, sizeof lanes);
  return lanes;
}
template <typename Lanes>
void addTo(float* to, Lanes what) {
  what += lanesOf(to, Lanes{});
  std::memcpy(to, &what, sizeof what);
}

// By distance in rows. The square of (1 - t) h_m + t h_(m+1) is taken for the sum of h'^2 about the
// same two rows, weighted by (1 - t)^2 + cross t (1 - t) and t^2 + cross t (1 - t): with cross =
// exp(-1 / 4 sigma^2) = h_m h_(m+1) / h_(m+1/2)^2, and with h'^2 narrower than h^2 by what two rows
// widen it. The sum over all rows is exact; that over the scatterers between any two rows is within
// 1 % from 2 rows a deviation on.
struct LateralTaps {
  std::vector<double> bells, squares;
  double cross;

  LateralTaps(double deviation, int count) : cross(std::exp(-0.25 / (deviation * deviation))) {
    constexpr double kWidened = 0.076;  // rows^2, which leaves the least error
    const double narrow = std::sqrt(0.5 * deviation * deviation - kWidened);
    const auto reach = std::min<double>(count, std::ceil(kCutDeviations * deviation - 0.5));
    for (int t = 0; t <= count; ++t) {
      bells.push_back(t <= reach ? bell(t, deviation) : 0);
      squares.push_back(t <= reach ? bell(t, narrow) : 0);
    }
    double exact = 0, sum = 0;
    for (std::size_t t = 0; t < bells.size(); ++t) {
      const double beside = t + 1 < bells.size() ? bells[t + 1] : 0;
      exact += (t == 0 ? 1 : 2) * bells[t] * bells[t] + bells[t] * beside;
      sum += (t == 0 ? 1 : 2) * squares[t] * (1 + 0.5 * cross);
    }
    for (double& square : squares) square *= exact / sum;
  }
};

}  // namespace

SplatSums::SplatSums(const Probe& probe, const PointSpread& spread, const BeamView& view)
    : lines_(probe.lines),
      samples_(probe.samples),
      length_(roundedUp(probe.samples, kPiece)),
      axial_(spread.axial_m / probe.sampleSpacing(), kFours) {
  const ScanGeometry geometry(probe);
  const double middle = view.lateralLines(geometry.sampleDepth(samples_ / 2));
  rows_per_line_ = std::clamp(static_cast<int>(std::ceil(kRowsPerDeviation / middle)), 1,
                              lines_ > 1 ? kMostRowsPerLine : 1);
  // Two rows widen the bell by t (1 - t), on average a sixth of a row squared.
  constexpr double kWidened = 1.0 / 6;
  std::vector<double> deviations;
  for (int k = 0; k < samples_; ++k) {
    const double rows = rows_per_line_ * view.lateralLines(geometry.sampleDepth(k));
    deviations.push_back(std::sqrt(std::max(rows * rows - kWidened, kLeastRows * kLeastRows)));
  }
  const auto [least, most] = std::minmax_element(deviations.begin(), deviations.end());
  even_ = *most - *least < 1e-6 * *most;
  taps_ =
      std::min(static_cast<int>(std::ceil(kCutDeviations * *most - 0.5)), lines_ * rows_per_line_);
  pad_ = roundedUp(axial_.taps(), kCacheLine);
  // An odd number of cache lines: rows a power of two apart would share few sets of the cache.
  stride_ = (roundedUp(length_ + 2 * pad_, kCacheLine) / kCacheLine | 1) * kCacheLine;
  const auto size = static_cast<std::size_t>(taps_ + 1) * static_cast<std::size_t>(length_);
  lateral_.resize(size);
  squares_.resize(size);
  for (std::ptrdiff_t k = 0; k < length_; ++k) {
    const double deviation =
        deviations[static_cast<std::size_t>(std::min<std::ptrdiff_t>(k, samples_ - 1))];
    const LateralTaps taps(deviation, taps_);
    for (int t = 0; t <= taps_; ++t) {
      const auto at = static_cast<std::size_t>(t * length_ + k);
      lateral_[at] = static_cast<float>(taps.bells[static_cast<std::size_t>(t)]);
      squares_[at] = static_cast<float>(taps.squares[static_cast<std::size_t>(t)]);
    }
    cross_.push_back(static_cast<float>(taps.cross));
  }
}

// Used round, from one that no splat reaches before.
float* SplatSums::row(Rows& rows, int number) const {
  const std::ptrdiff_t slots =
      static_cast<std::ptrdiff_t>(rows.rows.size()) * kCacheLine / (kPlanes * stride_);
  return rows.rows.front().floats +
         (number + 4 * taps_ + 4 * rows_per_line_ + 8) % slots * kPlanes * stride_ + pad_;
}

// The last one at a place or before it, by lines from the middle of line 0.
int SplatSums::rowBefore(double line) const {
  return static_cast<int>(std::floor(line * rows_per_line_));
}

LineRange SplatSums::reach(LineRange lines) const {
  const int beside = (2 * taps_ + 2 + rows_per_line_) / (2 * rows_per_line_);
  return {std::max(lines.first - beside, 0), std::min(lines.end + beside, lines_)};
}

void SplatSums::start(LineRange lines, Rows& rows) const {
  const int slots = 4 * taps_ + (kGroup + 3) * rows_per_line_ + 8;
  rows.rows.resize(static_cast<std::size_t>(slots * kPlanes * stride_ / kCacheLine));
  rows.sums.resize(static_cast<std::size_t>(kGroup * 3 * stride_ / kCacheLine));
  rows.amplitudes.resize(static_cast<std::size_t>(samples_));
  rows.next =
      std::min(lines.first * rows_per_line_ - taps_, rowBefore(reach(lines).first - 0.5)) - 1;
}

SplatSums::Line SplatSums::line(const Rows& rows, int member) const {
  const float* first = rows.sums.front().floats + member * 3 * stride_;
  return {first, first + stride_, first + 2 * stride_};
}

template <int eights, int fours>
void SplatSums::addAll(std::span<const Splat> splats, int line, const float* intensities,
                       Rows& rows) const {
  constexpr std::ptrdiff_t kAhead = 32;  // our choice, by time
  const int first = rowBefore(line - 0.5);
  float* of_row[kMostRowsPerLine + 3];
  for (int n = 0; n <= rows_per_line_ + 2; ++n) of_row[n] = row(rows, first + n);
  const float lowest =
      static_cast<float>(line * rows_per_line_ - first) - 0.5f * static_cast<float>(rows_per_line_);
  const float per_step = static_cast<float>(rows_per_line_) / kTapSteps;
  const std::ptrdiff_t next = stride_;
  for (const Splat& splat : splats) {
    __builtin_prefetch(&splat + kAhead);
    const int sample = splat.sample();
    const float amplitude = rows.amplitudes[static_cast<std::size_t>(sample)];
    const float re = amplitude * splat.real, im = amplitude * splat.imaginary,
                square = intensities[sample] * splat.square;
    const float at = lowest + per_step * (static_cast<float>(splat.lineStep()) + 0.5f);
    const int n = static_cast<int>(at);
    const float t = at - static_cast<float>(n), s = 1 - t;
    const float* axial = axial_.row(splat.sampleStep());
    const std::ptrdiff_t from = sample + axial_.first(splat.sampleStep());
    float *one = of_row[n] + from, *two = of_row[n + 1] + from;
    const float both = cross_[static_cast<std::size_t>(even_ ? 0 : sample)] * s * t;
    const float r1 = s * re, i1 = s * im, w1 = (s * s + both) * square, r2 = t * re, i2 = t * im,
                w2 = (t * t + both) * square;
    const auto chunk = [&](auto lanes, int offset) {
      const auto h = lanesOf(axial + offset, lanes), hh = h * h;
      addTo(one + offset, r1 * h);
      addTo(one + next + offset, i1 * h);
      addTo(one + 2 * next + offset, w1 * hh);
      addTo(two + offset, r2 * h);
      addTo(two + next + offset, i2 * h);
      addTo(two + 2 * next + offset, w2 * hh);
    };
    const int full = eights >= 0 ? eights : axial_.taps() / 8;
    for (int e = 0; e < full; ++e) chunk(Floats8{}, 8 * e);
    if (fours > 0 || (fours < 0 && axial_.taps() % 8 != 0)) chunk(Floats4{}, 8 * full);
  }
}

void SplatSums::add(std::span<const Splat> splats, int line, const float* intensities,
                    Rows& rows) const {
  for (const int end = rowBefore(line + 0.5) + 3; rows.next < end; ++rows.next) {
    float* from = row(rows, rows.next) - pad_;
    std::fill(from, from + kPlanes * stride_, 0.0f);
  }
  for (int k = 0; k < samples_; ++k)
    rows.amplitudes[static_cast<std::size_t>(k)] = std::sqrt(intensities[k]);
  if (axial_.taps() == 8)
    addAll<1, 0>(splats, line, intensities, rows);
  else if (axial_.taps() == 12)
    addAll<1, 1>(splats, line, intensities, rows);
  else
    addAll<-1, -1>(splats, line, intensities, rows);
}

template <bool even>
void SplatSums::sumRows(LineRange group, Rows& rows) const {
  const std::ptrdiff_t next = stride_;
  std::vector<const float*> of_row;
  const int first = group.first * rows_per_line_ - taps_,
            last = (group.end - 1) * rows_per_line_ + taps_;
  for (int n = first; n <= last; ++n) of_row.push_back(row(rows, n));
  const auto tap = [&](const std::vector<float>& from, int t, std::ptrdiff_t k) {
    const float* taps = from.data() + t * length_;
    return even ? Floats8{} + taps[0] : lanesAt(taps + k);
  };
  // Pairs of rows either side.
  const auto step = [&](const float* const* middle, std::ptrdiff_t k, float* to) {
    Floats8 r[kSumChains], i[kSumChains], s[kSumChains];
    for (std::ptrdiff_t c = 0; c < kSumChains; ++c) {
      const std::ptrdiff_t at = k + c * kSumLanes;
      const float* row = *middle + at;
      r[c] = tap(lateral_, 0, at) * lanesAt(row);
      i[c] = tap(lateral_, 0, at) * lanesAt(row + next);
      s[c] = tap(squares_, 0, at) * lanesAt(row + 2 * next);
    }
    for (int t = 1; t <= taps_; ++t) {
      const float *below = *(middle - t), *above = *(middle + t);
      for (std::ptrdiff_t c = 0; c < kSumChains; ++c) {
        const std::ptrdiff_t at = k + c * kSumLanes;
        const Floats8 h = tap(lateral_, t, at);
        r[c] += h * (lanesAt(below + at) + lanesAt(above + at));
        i[c] += h * (lanesAt(below + next + at) + lanesAt(above + next + at));
        s[c] += tap(squares_, t, at) *
                (lanesAt(below + 2 * next + at) + lanesAt(above + 2 * next + at));
      }
    }
    for (std::ptrdiff_t c = 0; c < kSumChains; ++c) {
      const std::ptrdiff_t at = k + c * kSumLanes;
      store(r[c], to + at);
      store(i[c], to + next + at);
      store(s[c], to + 2 * next + at);
    }
  };
  for (std::ptrdiff_t from = 0; from < length_; from += kPiece)
    for (int i = 0; i < group.count(); ++i)
      for (std::ptrdiff_t k = from; k < from + kPiece; k += kSumStep)
        step(of_row.data() + taps_ + i * rows_per_line_, k,
             rows.sums.front().floats + i * 3 * stride_);
}

void SplatSums::sum(LineRange group, Rows& rows) const {
  for (const int end = (group.end - 1) * rows_per_line_ + taps_ + 1; rows.next < end; ++rows.next) {
    float* from = row(rows, rows.next) - pad_;
    std::fill(from, from + kPlanes * stride_, 0.0f);
  }
  even_ ? sumRows<true>(group, rows) : sumRows<false>(group, rows);
}

}  // namespace echocine
