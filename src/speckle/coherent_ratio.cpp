#include "speckle/coherent_ratio.h"

#include <algorithm>
#include <cmath>

#include "scene/scan_geometry.h"
#include "speckle/point_spread.h"

namespace echocine {

namespace {

// Bells end where they have 4 % of the amplitude. Both sums end there, so no law depends on it.
constexpr double kCutDeviations = 2.5;
constexpr std::size_t kMostTaps = 64;
constexpr std::size_t kPad = kMostTaps + 2 * kFloatLanes;  // of a row, either end

std::size_t tapsOf(double deviation) {
  return std::min(static_cast<std::size_t>(std::ceil(kCutDeviations * deviation)), kMostTaps);
}

// Four independent sums at once.
constexpr std::size_t kChains = 4, kStep = kChains * kFloatLanes;

// Lines are smeared across by groups, piece by piece: what one has read the next finds in the
// nearest cache. By time.
constexpr int kGroup = 4;
constexpr std::size_t kPiece = 2 * kStep;

// Whole steps.
std::size_t lengthOf(int samples) {
  return (static_cast<std::size_t>(samples) + kStep - 1) / kStep * kStep;
}

// The first place of a row in memory that begins with a cache line.
float* floatsOf(std::vector<CacheLine>& lines) {
  return lines.front().floats;
}
void setFloats(std::vector<CacheLine>& lines, std::size_t count) {
  lines.assign((count + std::size(CacheLine{}.floats) - 1) / std::size(CacheLine{}.floats), {});
}

std::vector<float> bellTaps(double deviation) {
  std::vector<float> taps;
  for (std::size_t t = 0; t <= tapsOf(deviation); ++t)
    taps.push_back(static_cast<float>(bell(static_cast<double>(t), deviation)));
  return taps;
}

std::vector<float> normalisedTaps(double deviation) {
  std::vector<float> taps = bellTaps(deviation);
  float sum = 0;
  for (std::size_t t = 0; t < taps.size(); ++t) sum += (t == 0 ? 1 : 2) * taps[t];
  for (float& tap : taps) tap /= sum;
  return taps;
}

}  // namespace

CoherentRatio::CoherentRatio(const Probe& probe, const PointSpread& spread, const BeamView& view,
                             double smoothing_m)
    : lines_(probe.lines),
      samples_(probe.samples),
      length_(lengthOf(probe.samples)),
      // An odd number of cache lines: rows a power of two apart would share few sets of the cache.
      stride_(length_ + sizeof(CacheLine) / sizeof(float)),
      axial_(bellTaps(spread.axial_m / probe.sampleSpacing())),
      smoothing_(normalisedTaps(smoothing_m / kWidthAtHalf / probe.sampleSpacing())) {
  for (const float h : axial_) axial_squares_.push_back(h * h);
  const ScanGeometry geometry(probe);
  std::vector<double> deviations;
  for (int k = 0; k < samples_; ++k)
    deviations.push_back(view.lateralLines(geometry.sampleDepth(k)));
  const auto [least, most] = std::minmax_element(deviations.begin(), deviations.end());
  even_ = *most - *least < 1e-6 * *most;
  lateral_taps_ = std::min(tapsOf(*most), static_cast<std::size_t>(lines_ - 1));
  lateral_.resize((lateral_taps_ + 1) * stride_);
  for (std::size_t t = 0; t <= lateral_taps_; ++t)
    for (std::size_t k = 0; k < deviations.size(); ++k)
      if (t <= tapsOf(deviations[k]))
        lateral_[t * stride_ + k] = static_cast<float>(bell(static_cast<double>(t), deviations[k]));
  for (const float h : lateral_) lateral_squares_.push_back(h * h);
}

float* CoherentRatio::smeared(Rows& rows, int line) const {
  const std::size_t slots = 2 * lateral_taps_ + kGroup;
  return floatsOf(rows.lines) + static_cast<std::size_t>(line) % slots * 3 * stride_;
}
float* CoherentRatio::ratioOf(Rows& rows, int member) const {
  return floatsOf(rows.ratios) + static_cast<std::size_t>(member) * (stride_ + 2 * kPad) + kPad;
}
float* CoherentRatio::echoesOf(Rows& rows, int member) const {
  return floatsOf(rows.echoes) + static_cast<std::size_t>(member) * 3 * stride_;
}

namespace {

Floats8 roots(Floats8 a) {
  Floats8 out;
  for (std::size_t i = 0; i < kFloatLanes; ++i) out[i] = std::sqrt(a[i]);
  return out;
}

Floats8 someLanesAt(const float* from, int count) {
  if (count >= static_cast<int>(kFloatLanes)) return lanesAt(from);
  Floats8 lanes{};
  std::memcpy(&lanes, from, static_cast<std::size_t>(count) * sizeof(float));
  return lanes;
}

Floats8 allOf(float a) {
  return Floats8{a, a, a, a, a, a, a, a};
}

// A row with its neighbours either side, by taps of distance 0, 1, ...
template <typename Take>
void smear(const float* row, std::size_t length, const std::vector<float>& by, const Take& take) {
  float taps[kMostTaps + 1];
  const std::size_t count = by.size();
  std::copy(by.begin(), by.end(), taps);
  for (std::size_t k = 0; k < length; k += kStep) {
    Floats8 sums[kChains];
    for (std::size_t c = 0; c < kChains; ++c)
      sums[c] = allOf(taps[0]) * lanesAt(row + k + c * kFloatLanes);
    for (std::size_t t = 1; t < count; ++t) {
      const Floats8 h = allOf(taps[t]);
      const float *before = row + k - t, *after = row + k + t;
      for (std::size_t c = 0; c < kChains; ++c)
        sums[c] += h * (lanesAt(before + c * kFloatLanes) + lanesAt(after + c * kFloatLanes));
    }
    for (std::size_t c = 0; c < kChains; ++c) take(sums[c], k + c * kFloatLanes);
  }
}

}  // namespace

// One line's splats, added up, weighted by the picture, and smeared along it.
void CoherentRatio::alongLine(std::span<const Splat> scattered, const float* intensities,
                              Rows& rows, float* out) const {
  const std::size_t length = stride_ + 2 * kPad;
  float *real = floatsOf(rows.raw) + kPad, *imaginary = real + length,
        *squares = imaginary + length;
  for (float* row : {real, imaginary, squares}) std::fill(row, row + length_, 0.0f);
  constexpr std::ptrdiff_t kAhead = 32;  // our choice, by time
  for (const Splat& splat : scattered) {
    __builtin_prefetch(&splat + kAhead);
    real[splat.sample] += splat.real;
    imaginary[splat.sample] += splat.imaginary;
    squares[splat.sample] += splat.square;
  }
  for (int k = 0; k < samples_; k += kFloatLanes) {
    const Floats8 intensity = someLanesAt(intensities + k, samples_ - k);
    const Floats8 amplitude = roots(intensity);
    store(amplitude * lanesAt(real + k), real + k);
    store(amplitude * lanesAt(imaginary + k), imaginary + k);
    store(intensity * lanesAt(squares + k), squares + k);
  }
  const auto to = [](float* plane) {
    return [plane](Floats8 lanes, std::size_t k) { store(lanes, plane + k); };
  };
  smear(real, length_, axial_, to(out));
  smear(imaginary, length_, axial_, to(out + stride_));
  smear(squares, length_, axial_squares_, to(out + 2 * stride_));
}

// The coherent part of a line's samples. Rounding may leave q slightly above 1.
void CoherentRatio::shareOut(const CoherentEchoes& echoes, int line, const float* intensities,
                             float* rest) const {
  const std::size_t first = static_cast<std::size_t>(line) * static_cast<std::size_t>(samples_);
  float *real = rest + stride_, *imaginary = real + stride_;
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

// |g|^2 / w of a group of lines, 1 where no scatterer is in reach; with what is coherent beside it.
template <bool even, bool coherent>
void CoherentRatio::acrossLines(LineRange group, Rows& rows) const {
  constexpr float kNothing = 1e-35f;
  const std::size_t stride = stride_, count = lateral_taps_;
  const float* lines[kGroup + 2 * kMostTaps];  // from the first that the group's bells reach
  for (std::size_t n = 0; n < kGroup + 2 * count; ++n) {
    const int line = group.first - static_cast<int>(count) + static_cast<int>(n);
    lines[n] = line >= 0 && line < lines_ ? smeared(rows, line) : floatsOf(rows.nothing);
  }
  const float *taps = lateral_.data(), *squares = lateral_squares_.data();
  const auto tap = [&](const float* from, std::size_t t, std::size_t k) {
    return even ? allOf(from[t * stride]) : lanesAt(from + t * stride + k);
  };
  struct Sum {
    Floats8 r, i, s;
    void add(const float* a, const float* b, std::size_t next, Floats8 h, Floats8 hh) {
      r += h * (lanesAt(a) + lanesAt(b));
      i += h * (lanesAt(a + next) + lanesAt(b + next));
      s += hh * (lanesAt(a + 2 * next) + lanesAt(b + 2 * next));
    }
    Floats8 ratio(const float* echoes, std::size_t next) const {
      const Floats8 one = Floats8{} + 1, w = s > kNothing ? s : one;
      if constexpr (coherent) {
        const Floats8 rest = lanesAt(echoes) / roots(w);
        const Floats8 re = rest * r + lanesAt(echoes + next),
                      im = rest * i + lanesAt(echoes + 2 * next);
        return s > kNothing ? re * re + im * im : one;
      }
      return s > kNothing ? (r * r + i * i) / w : one;
    }
  };
  const auto step = [&](const float* const* middle, std::size_t k, const float* echoes,
                        float* ratio) {
    Sum sums[kChains];
    for (std::size_t c = 0; c < kChains; ++c) {
      const std::size_t at = k + c * kFloatLanes;
      const Floats8 h = tap(taps, 0, at), hh = tap(squares, 0, at);
      const float* row = *middle + at;
      sums[c] = {h * lanesAt(row), h * lanesAt(row + stride), hh * lanesAt(row + 2 * stride)};
    }
    for (std::size_t t = 1; t <= count; ++t) {
      const float *below = *(middle - t), *above = *(middle + t);
      for (std::size_t c = 0; c < kChains; ++c) {
        const std::size_t at = k + c * kFloatLanes;
        sums[c].add(below + at, above + at, stride, tap(taps, t, at), tap(squares, t, at));
      }
    }
    for (std::size_t c = 0; c < kChains; ++c)
      store(sums[c].ratio(echoes + k + c * kFloatLanes, stride), ratio + k + c * kFloatLanes);
  };
  for (std::size_t from = 0; from < length_; from += kPiece)
    for (int i = 0; i < group.end - group.first; ++i)
      for (std::size_t k = from; k < std::min(from + kPiece, length_); k += kStep)
        step(lines + count + i, k, echoesOf(rows, i), ratioOf(rows, i));
}

void CoherentRatio::finish(float* ratio, float* intensities) const {
  for (std::size_t t = 1; t < smoothing_.size(); ++t) {  // ends are mirrored: the mean stays
    ratio[-static_cast<std::ptrdiff_t>(t)] =
        ratio[std::min<int>(static_cast<int>(t), samples_) - 1];
    ratio[samples_ + static_cast<int>(t) - 1] = ratio[std::max(samples_ - static_cast<int>(t), 0)];
  }
  smear(ratio, length_, smoothing_, [&](Floats8 smooth, std::size_t k) {
    const int left = samples_ - static_cast<int>(k);
    if (left > 0)
      storeSome(someLanesAt(intensities + k, left) * smooth, static_cast<std::size_t>(left),
                intensities + k);
  });
}

LineRange CoherentRatio::reach(LineRange lines) const {
  const int taps = static_cast<int>(lateral_taps_);
  return {std::max(lines.first - taps, 0), std::min(lines.end + taps, lines_)};
}

void CoherentRatio::apply(const SplatLists& scattered, Rows& rows, std::span<float> intensities,
                          const CoherentEchoes& echoes, LineRange lines) const {
  const auto plane = [&](int line) {
    return intensities.data() + static_cast<std::ptrdiff_t>(line) * samples_;
  };
  setFloats(rows.raw, 3 * (stride_ + 2 * kPad));
  setFloats(rows.lines, (2 * lateral_taps_ + kGroup) * 3 * stride_);
  setFloats(rows.ratios, kGroup * (stride_ + 2 * kPad));
  setFloats(rows.nothing, 3 * stride_);
  setFloats(rows.echoes, kGroup * 3 * stride_);
  const auto across = echoes.empty() ? even_ ? &CoherentRatio::acrossLines<true, false>
                                             : &CoherentRatio::acrossLines<false, false>
                      : even_ ? &CoherentRatio::acrossLines<true, true>
                                     : &CoherentRatio::acrossLines<false, true>;
  // A line is smeared along as soon as it comes, and a group across once the lines that its bells
  // reach are there; its intensities have then been read by all who need them.
  int next = reach(lines).first;
  for (int first = lines.first; first < lines.end; first += kGroup) {
    const LineRange group{first, std::min(first + kGroup, lines.end)};
    for (const int end = reach(group).end; next < end; ++next)
      alongLine(scattered.line(next), plane(next), rows, smeared(rows, next));
    if (!echoes.empty())
      for (int i = group.first; i < group.end; ++i)
        shareOut(echoes, i, plane(i), echoesOf(rows, i - first));
    (this->*across)(group, rows);
    for (int i = group.first; i < group.end; ++i) finish(ratioOf(rows, i - first), plane(i));
  }
}

}  // namespace echocine
