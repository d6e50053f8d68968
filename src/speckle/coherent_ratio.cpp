#include "speckle/coherent_ratio.h"

#include <algorithm>
#include <cmath>

#include "speckle/point_spread.h"

namespace echocine {

namespace {

// What a line's rows are rounded up to.
constexpr std::size_t kRowStep = 4 * kFloatLanes;

std::size_t lengthOf(int samples) {
  return (static_cast<std::size_t>(samples) + kRowStep - 1) / kRowStep * kRowStep;
}

float* floatsOf(std::vector<CacheLine>& lines) {
  return lines.front().floats;
}
void setFloats(std::vector<CacheLine>& lines, std::size_t count) {
  lines.assign((count + std::size(CacheLine{}.floats) - 1) / std::size(CacheLine{}.floats), {});
}

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

}  // namespace

CoherentRatio::CoherentRatio(const Probe& probe, const PointSpread& spread, const BeamView& view,
                             double smoothing_m)
    : samples_(probe.samples),
      length_(lengthOf(probe.samples)),
      sums_(probe, spread, view),
      smoothing_(probe.samples, smoothing_m / kWidthAtHalf / probe.sampleSpacing()) {}

float* CoherentRatio::ratio(Rows& rows) const {
  return floatsOf(rows.ratio) + smoothing_.margin();
}

// What of a line's samples is coherent. Rounding may leave q a little over 1.
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

// |g|^2 / w of a line, 1 where no scatterer is in reach; with what is coherent beside it.
template <bool coherent>
void CoherentRatio::ratioOf(const SplatSums::Line& sums, const float* echoes, float* ratio) const {
  constexpr float kNothing = 1e-35f;
  const Floats8 one = Floats8{} + 1;
  for (std::size_t k = 0; k < static_cast<std::size_t>(samples_); k += kFloatLanes) {
    const Floats8 r = lanesAt(sums.real + k), i = lanesAt(sums.imaginary + k),
                  s = lanesAt(sums.squares + k), w = s > kNothing ? s : one;
    Floats8 of = (r * r + i * i) / w;
    if constexpr (coherent) {
      const Floats8 rest = lanesAt(echoes + k) / roots(w);
      const Floats8 re = rest * r + lanesAt(echoes + k + length_),
                    im = rest * i + lanesAt(echoes + k + 2 * length_);
      of = re * re + im * im;
    }
    store(s > kNothing ? of : one, ratio + k);
  }
}

void CoherentRatio::finish(Rows& rows, float* intensities) const {
  float *of = ratio(rows), *smooth = of + length_ + smoothing_.margin();
  smoothing_.apply(of, rows.coarse, smooth);
  for (int k = 0; k < samples_; k += kFloatLanes) {
    const int left = samples_ - k;
    storeSome(someLanesAt(intensities + k, left) * lanesAt(smooth + k),
              static_cast<std::size_t>(left), intensities + k);
  }
}

// A group of lines is finished as soon as the lines that reach into it are there. Its intensities
// have then been read by all who need them.
void CoherentRatio::apply(const SplatLists& scattered, Rows& rows, std::span<float> intensities,
                          const CoherentEchoes& echoes, LineRange lines) const {
  const auto plane = [&](int line) {
    return intensities.data() + static_cast<std::ptrdiff_t>(line) * samples_;
  };
  sums_.start(lines, rows.sums);
  setFloats(rows.ratio, 2 * (length_ + static_cast<std::size_t>(smoothing_.margin())));
  setFloats(rows.echoes, 3 * length_);
  int next = reach(lines).first;
  for (int first = lines.first; first < lines.end; first += SplatSums::kGroup) {
    const LineRange group{first, std::min(first + SplatSums::kGroup, lines.end)};
    for (const int end = reach(group).end; next < end; ++next)
      sums_.add(scattered.line(next), next, plane(next), rows.sums);
    sums_.sum(group, rows.sums);
    for (int i = group.first; i < group.end; ++i) {
      const SplatSums::Line sums = sums_.line(rows.sums, i - first);
      if (echoes.empty()) {
        ratioOf<false>(sums, nullptr, ratio(rows));
      } else {
        shareOut(echoes, i, plane(i), floatsOf(rows.echoes));
        ratioOf<true>(sums, floatsOf(rows.echoes), ratio(rows));
      }
      finish(rows, plane(i));
    }
  }
}

}  // namespace echocine
