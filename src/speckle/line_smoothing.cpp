#include "speckle/line_smoothing.h"

#include <algorithm>
#include <cmath>

#include "core/lanes.h"
#include "speckle/point_spread.h"

namespace echocine {

namespace {

// Bells of 8 blocks or more are taken of the means of blocks. By time, and within 1e-3.
constexpr double kBlocksPerDeviation = 8;
// Summed at once: four chains that do not wait for each other.
constexpr int kChains = 4, kLanes = static_cast<int>(kFloatLanes), kStep = kChains * kLanes;

Floats8 allOf(float a) {
  return Floats8{} + a;
}

int blockOf(double deviation_samples) {
  return std::max(1, static_cast<int>(deviation_samples / kBlocksPerDeviation));
}

// In blocks. Means over blocks, and straight lines between them, widen the bell too: by
// (block^2 - 1) / 12 and block^2 / 6 samples^2 of its variance.
double deviationOf(double deviation_samples, double block) {
  if (block == 1) return deviation_samples;
  const double widened = (block * block - 1) / 12 + block * block / 6;
  return std::sqrt(deviation_samples * deviation_samples - widened) / block;
}

}  // namespace

LineSmoothing::LineSmoothing(int samples, double deviation_samples)
    : samples_(samples), block_(blockOf(deviation_samples)) {
  const double deviation = deviationOf(deviation_samples, block_);
  const int reach = static_cast<int>(std::ceil(kCutDeviations * deviation));
  float sum = 0;
  for (int t = 0; t <= reach; ++t) {
    taps_.push_back(static_cast<float>(bell(t, deviation)));
    sum += (t == 0 ? 1 : 2) * taps_.back();
  }
  for (float& tap : taps_) tap /= sum;
  margin_ = (reach + 2) * block_ + kStep;
}

int LineSmoothing::length() const {
  return (samples_ + kStep - 1) / kStep * kStep;
}

// `to` takes whole steps.
void LineSmoothing::smear(const float* from, int count, float* to) const {
  for (int k = 0; k < count; k += kStep) {
    Floats8 sums[kChains];
    for (int c = 0; c < kChains; ++c)
      sums[c] = allOf(taps_.front()) * lanesAt(from + k + c * kLanes);
    for (std::size_t t = 1; t < taps_.size(); ++t) {
      const Floats8 h = allOf(taps_[t]);
      const float *before = from + k - t, *after = from + k + t;
      for (int c = 0; c < kChains; ++c)
        sums[c] += h * (lanesAt(before + c * kLanes) + lanesAt(after + c * kLanes));
    }
    for (int c = 0; c < kChains; ++c) store(sums[c], to + k + c * kLanes);
  }
}

void LineSmoothing::apply(float* line, std::vector<float>& coarse, float* out) const {
  const int mirrored = margin_ - kStep;
  for (int t = 1; t <= mirrored; ++t) {
    line[-t] = line[std::min(t, samples_) - 1];
    line[samples_ + t - 1] = line[std::max(samples_ - t, 0)];
  }
  if (block_ == 1)
    smear(line, samples_, out);
  else
    throughBlocks(line, coarse, out);
}

void LineSmoothing::throughBlocks(const float* line, std::vector<float>& coarse, float* out) const {
  const int reach = static_cast<int>(taps_.size()) - 1;
  const int blocks = (samples_ + block_ - 1) / block_ + 2;  // from the one before the line
  const int room = (blocks + 2 * reach + 2 * kStep) / kStep * kStep;
  coarse.assign(static_cast<std::size_t>(2 * room), 0.0f);
  float *means = coarse.data(), *smooth = means + room;
  for (int b = 0; b < blocks + 2 * reach; ++b) {
    const int first = (b - 1 - reach) * block_;
    if (first + block_ > samples_ + margin_) break;
    float sum = 0;
    for (int k = first; k < first + block_; ++k) sum += line[k];
    means[b] = sum / static_cast<float>(block_);
  }
  smear(means + reach, blocks, smooth);
  const float per_block = 1 / static_cast<float>(block_);
  const float middle = 0.5f * static_cast<float>(block_ - 1);
  for (int k = 0; k < samples_; ++k) {
    const float at = (static_cast<float>(k) - middle) * per_block + 1;  // 1: the line's first block
    const int b = static_cast<int>(at);
    const float part = at - static_cast<float>(b);
    out[k] = smooth[b] + part * (smooth[b + 1] - smooth[b]);
  }
}

}  // namespace echocine
