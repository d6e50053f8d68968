#include "speckle/coherent_ratio.h"

#include <algorithm>
#include <cmath>

#include "scene/scan_geometry.h"
#include "speckle/point_spread.h"

namespace echocine {

namespace {

// Where bells are cut: 4 % of the amplitude. Both sums are cut alike, so no law depends on it.
constexpr double kCutDeviations = 2.5;
constexpr std::size_t kMostTaps = 64;
constexpr std::size_t kPad = kMostTaps + 2 * kFloatLanes;  // of a row, either end

std::size_t tapsOf(double deviation) {
  return std::min(static_cast<std::size_t>(std::ceil(kCutDeviations * deviation)), kMostTaps);
}

// Whole cache lines, an odd number of them: rows a power of two apart would share few sets of it.
std::size_t strideOf(int samples) {
  constexpr std::size_t kLine = sizeof(CacheLine) / sizeof(float);
  return ((static_cast<std::size_t>(samples) + kLine - 1) / kLine | 1) * kLine;
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
      stride_(strideOf(probe.samples)),
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
  const std::size_t slots = 2 * lateral_taps_ + 1;
  return floatsOf(rows.lines) + static_cast<std::size_t>(line) % slots * 3 * stride_;
}

namespace {

// Eight samples' sums, read side by side and cleared.
struct Sums8 {
  Floats8 real, imaginary, squares;
  explicit Sums8(EchoSum* from) {
    const float* f = &from->real;
    const Floats8 a = lanesAt(f), b = lanesAt(f + 8), c = lanesAt(f + 16), d = lanesAt(f + 24);
    // Samples 0, 2, 4, 6 then 1, 3, 5, 7 of two numbers each.
    const Floats8 ri0 = __builtin_shufflevector(a, b, 0, 4, 1, 5, 8, 12, 9, 13),
                  ri1 = __builtin_shufflevector(c, d, 0, 4, 1, 5, 8, 12, 9, 13),
                  s0 = __builtin_shufflevector(a, b, 2, 6, 2, 6, 10, 14, 10, 14),
                  s1 = __builtin_shufflevector(c, d, 2, 6, 2, 6, 10, 14, 10, 14);
    real = __builtin_shufflevector(ri0, ri1, 0, 1, 4, 5, 8, 9, 12, 13);
    imaginary = __builtin_shufflevector(ri0, ri1, 2, 3, 6, 7, 10, 11, 14, 15);
    squares = __builtin_shufflevector(s0, s1, 0, 1, 4, 5, 8, 9, 12, 13);
    for (std::size_t i = 0; i < kFloatLanes; ++i) from[i] = {};
  }
};

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

// A row with its neighbours either side, by taps of distance 0, 1, ...; sixteen at a time, two
// chains of sums that do not wait for each other.
template <typename Take>
void smear(const float* row, std::size_t length, const std::vector<float>& by, const Take& take) {
  float taps[kMostTaps + 1];
  const std::size_t count = by.size();
  std::copy(by.begin(), by.end(), taps);
  for (std::size_t k = 0; k < length; k += 2 * kFloatLanes) {
    const float *one = row + k, *two = one + kFloatLanes;
    Floats8 a = taps[0] * lanesAt(one), b = taps[0] * lanesAt(two);
    for (std::size_t t = 1; t < count; ++t) {
      a += taps[t] * (lanesAt(one - t) + lanesAt(one + t));
      b += taps[t] * (lanesAt(two - t) + lanesAt(two + t));
    }
    take(a, k);
    take(b, k + kFloatLanes);
  }
}

}  // namespace

// One line's sums, weighted by the picture, and smeared along it.
void CoherentRatio::alongLine(EchoSum* sums, const float* intensities, Rows& rows,
                              float* out) const {
  const std::size_t length = stride_ + 2 * kPad;
  float *real = floatsOf(rows.raw) + kPad, *imaginary = real + length,
        *squares = imaginary + length;
  for (int k = 0; k < samples_; k += kFloatLanes) {
    const Sums8 sum(sums + k);
    const Floats8 intensity = someLanesAt(intensities + k, samples_ - k);
    const Floats8 amplitude = roots(intensity);
    store(amplitude * sum.real, real + k);
    store(amplitude * sum.imaginary, imaginary + k);
    store(intensity * sum.squares, squares + k);
  }
  const auto to = [](float* plane) {
    return [plane](Floats8 lanes, std::size_t k) { store(lanes, plane + k); };
  };
  smear(real, stride_, axial_, to(out));
  smear(imaginary, stride_, axial_, to(out + stride_));
  smear(squares, stride_, axial_squares_, to(out + 2 * stride_));
}

// What of a line's samples is coherent. Rounding may leave q a little over 1.
void CoherentRatio::shareOut(const CoherentEchoes& echoes, int line, const float* intensities,
                             Rows& rows) const {
  const std::size_t first = static_cast<std::size_t>(line) * static_cast<std::size_t>(samples_);
  float *rest = floatsOf(rows.echoes), *real = rest + stride_, *imaginary = real + stride_;
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

// |g|^2 / w of one line, 1 where no scatterer is in reach; with what is coherent beside it.
template <bool even, bool coherent>
void CoherentRatio::acrossLines(int line, Rows& rows) const {
  constexpr float kNothing = 1e-35f;
  float* ratio = floatsOf(rows.ratio) + kPad;
  const float *middle = smeared(rows, line), *echoes = floatsOf(rows.echoes);
  const float *below[kMostTaps + 1], *above[kMostTaps + 1];
  for (std::size_t t = 1; t <= lateral_taps_; ++t) {
    const int low = line - static_cast<int>(t), high = line + static_cast<int>(t);
    below[t] = low >= 0 ? smeared(rows, low) : floatsOf(rows.nothing);
    above[t] = high < lines_ ? smeared(rows, high) : floatsOf(rows.nothing);
  }
  const float *taps = lateral_.data(), *squares = lateral_squares_.data();
  const std::size_t stride = stride_, count = lateral_taps_;
  const auto tap = [&](const float* from, std::size_t t, std::size_t k) {
    return even ? Floats8{} + from[t * stride] : lanesAt(from + t * stride + k);
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
  const auto start = [&](std::size_t k) {
    const Floats8 h = tap(taps, 0, k), hh = tap(squares, 0, k);
    const float* at = middle + k;
    return Sum{h * lanesAt(at), h * lanesAt(at + stride), hh * lanesAt(at + 2 * stride)};
  };
  for (std::size_t k = 0; k < stride; k += 2 * kFloatLanes) {
    const std::size_t next = k + kFloatLanes;
    Sum one = start(k), two = start(next);
    for (std::size_t t = 1; t <= count; ++t) {
      const float *a = below[t], *b = above[t];
      one.add(a + k, b + k, stride, tap(taps, t, k), tap(squares, t, k));
      two.add(a + next, b + next, stride, tap(taps, t, next), tap(squares, t, next));
    }
    store(one.ratio(echoes + k, stride), ratio + k);
    store(two.ratio(echoes + next, stride), ratio + next);
  }
}

void CoherentRatio::finish(Rows& rows, float* intensities) const {
  float* ratio = floatsOf(rows.ratio) + kPad;
  for (std::size_t t = 1; t < smoothing_.size(); ++t) {  // ends are mirrored: the mean stays
    ratio[-static_cast<std::ptrdiff_t>(t)] =
        ratio[std::min<int>(static_cast<int>(t), samples_) - 1];
    ratio[samples_ + static_cast<int>(t) - 1] = ratio[std::max(samples_ - static_cast<int>(t), 0)];
  }
  smear(ratio, stride_, smoothing_, [&](Floats8 smooth, std::size_t k) {
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

void CoherentRatio::apply(EchoSums& sums, Rows& rows, std::span<float> intensities,
                          const CoherentEchoes& echoes, LineRange lines) const {
  const auto plane = [&](int line) {
    return intensities.data() + static_cast<std::ptrdiff_t>(line) * samples_;
  };
  setFloats(rows.raw, 3 * (stride_ + 2 * kPad));
  setFloats(rows.lines, (2 * lateral_taps_ + 1) * 3 * stride_);
  setFloats(rows.ratio, stride_ + 2 * kPad);
  setFloats(rows.nothing, 3 * stride_);
  setFloats(rows.echoes, 3 * stride_);
  const auto across = echoes.empty() ? even_ ? &CoherentRatio::acrossLines<true, false>
                                             : &CoherentRatio::acrossLines<false, false>
                      : even_ ? &CoherentRatio::acrossLines<true, true>
                                     : &CoherentRatio::acrossLines<false, true>;
  const int ahead = static_cast<int>(lateral_taps_);
  // A line is smeared along as soon as it comes, and across once the lines its bell reaches are
  // there; its intensities have then been read by all who need them.
  for (int i = reach(lines).first; i < lines.end + ahead; ++i) {
    if (i < lines_) alongLine(sums.line(i), plane(i), rows, smeared(rows, i));
    const int done = i - ahead;
    if (done < lines.first) continue;
    if (!echoes.empty()) shareOut(echoes, done, plane(done), rows);
    (this->*across)(done, rows);
    finish(rows, plane(done));
  }
}

}  // namespace echocine
