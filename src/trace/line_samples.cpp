#include "trace/line_samples.h"

#include <algorithm>
#include <cmath>

namespace echocine {

namespace {

constexpr int kBlock = 16;

// First sample whose centre is at or beyond a depth, within 0..samples.
int sampleFrom(const Sampling& s, double depth_m) {
  const double k = std::ceil((depth_m - s.min_depth_m) / s.spacing_m - 0.5);
  return static_cast<int>(std::clamp(k, 0.0, static_cast<double>(s.samples)));
}

// One stretch's backscatter in blocks of 16 samples: the exponential is taken once per block and goes on by
// stored powers, so the loop over a block holds no call and vectorises, and no rounding piles up along the line.
template <bool kSpread, bool kAttenuation>
void fillStretch(const Stretch& stretch, const Sampling& s, int begin, int end, float* out) {
  const double offset_m = s.centre(begin) - stretch.begin_depth_m;
  const double path_m = stretch.begin_path_m + stretch.path_per_depth * offset_m;
  const double path_step = stretch.path_per_depth * s.spacing_m;
  const double exponent = stretch.begin_exponent + stretch.exponent_per_m * offset_m;
  const double exponent_step = stretch.exponent_per_m * s.spacing_m;
  alignas(64) float power[kBlock];
  alignas(64) float path_offset[kBlock];
  for (int j = 0; j < kBlock; ++j) {
    power[j] = static_cast<float>(std::exp(-exponent_step * j));
    path_offset[j] = static_cast<float>(path_step * j);
  }
  for (int k = begin; k < end; k += kBlock) {
    const int done = k - begin;
    const double start = kAttenuation ? std::exp(-(exponent + exponent_step * done)) : 1.0;
    const float base = static_cast<float>(stretch.strength_m2_sr * start);
    const float l0 = static_cast<float>(path_m + path_step * done);
    alignas(64) float block[kBlock];
    for (int j = 0; j < kBlock; ++j) {
      const float l = l0 + path_offset[j];
      float value = base;
      if constexpr (kAttenuation) value *= power[j];
      if constexpr (kSpread) value /= l * l;
      block[j] = value;
    }
    std::copy_n(block, std::min(kBlock, end - k), out + k);
  }
}

void fillBackscatter(const LineTrace& line, const Sampling& s, const IntensityParts& parts,
                     float* out) {
  const bool spread = parts.spread_undone_at_m == 0;
  for (const Stretch& stretch : line.stretches) {
    const int begin = sampleFrom(s, stretch.begin_depth_m);
    const int end = sampleFrom(s, stretch.end_depth_m);
    if (begin >= end || stretch.strength_m2_sr == 0) continue;
    if (spread && parts.attenuation) {
      fillStretch<true, true>(stretch, s, begin, end, out);
    } else if (spread) {
      fillStretch<true, false>(stretch, s, begin, end, out);
    } else {
      Stretch scaled = stretch;
      scaled.strength_m2_sr /= parts.spread_undone_at_m * parts.spread_undone_at_m;
      if (parts.attenuation)
        fillStretch<false, true>(scaled, s, begin, end, out);
      else
        std::fill(out + begin, out + end, static_cast<float>(scaled.strength_m2_sr));
    }
  }
}

}  // namespace

void sampleIntensity(const LineTrace& line, const Sampling& sampling, const IntensityParts& parts,
                     std::span<float> values) {
  std::fill(values.begin(), values.end(), 0.0f);
  if (parts.backscatter) fillBackscatter(line, sampling, parts, values.data());
  if (!parts.reflection) return;
  for (const Echo& echo : line.echoes) {
    const double k = std::floor((echo.depth_m - sampling.min_depth_m) / sampling.spacing_m);
    if (k < 0 || k >= sampling.samples) continue;
    const double lost = parts.attenuation ? std::exp(-echo.exponent) : 1.0;
    values[static_cast<std::size_t>(k)] += static_cast<float>(echo.intensity * lost);
  }
}

void sampleExponent(const LineTrace& line, const Sampling& sampling, std::span<float> values) {
  std::fill(values.begin(), values.end(), 0.0f);
  for (const Stretch& stretch : line.stretches) {
    const int begin = sampleFrom(sampling, stretch.begin_depth_m);
    const int end = sampleFrom(sampling, stretch.end_depth_m);
    for (int k = begin; k < end; ++k)
      values[static_cast<std::size_t>(k)] = static_cast<float>(
          stretch.begin_exponent +
          stretch.exponent_per_m * (sampling.centre(k) - stretch.begin_depth_m));
  }
}

void sampleMedium(const LineTrace& line, const Sampling& sampling, std::span<std::uint32_t> ids) {
  std::fill(ids.begin(), ids.end(), kNoMedium);
  for (const Stretch& stretch : line.stretches) {
    const int begin = sampleFrom(sampling, stretch.begin_depth_m);
    const int end = sampleFrom(sampling, stretch.end_depth_m);
    if (begin < end)
      std::fill(ids.begin() + begin, ids.begin() + end,
                static_cast<std::uint32_t>(index(stretch.medium)));
  }
}

}  // namespace echocine
