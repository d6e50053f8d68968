#include "signal/field_sum.h"

#include <algorithm>

#include "core/lanes.h"
#include "speckle/point_spread.h"

namespace echocine {

FieldSum::FieldSum(const Scene& scene, const EffectPlan& plan, std::span<const float> gains)
    : lines_(scene.probe.lines),
      samples_(scene.probe.samples),
      smoothing_(samples_, scene.speckle.smoothing_m / kWidthAtHalf / scene.probe.sampleSpacing()) {
  if (plan.noise) levels_ = noiseLevels(scene, gains);
  if (plan.clutter) {
    levels_.resize(static_cast<std::size_t>(samples_));
    const std::vector<float> clutter = clutterLevels(scene);
    for (std::size_t k = 0; k < clutter.size(); ++k) levels_[k] += clutter[k];
  }
  if (plan.averaged) return;
  if (plan.clutter) clutter_.emplace(scene);
  if (plan.noise) noise_.emplace(scene, gains);
}

void FieldSum::addMean(double white, std::span<float> intensities) const {
  const float scale = heldWhite(white);
  const auto samples = static_cast<std::size_t>(samples_);
  for (std::size_t i = 0; i < intensities.size(); ++i)
    intensities[i] += scale * levels_[i % samples];
}

void FieldSum::add(double white, double time_s, const EchoField& field,
                   std::span<float> intensities) const {
  if (!adds()) return;
  if (!draws()) return addMean(white, intensities);
  const auto samples = static_cast<std::size_t>(samples_);
  const auto margin = static_cast<std::size_t>(smoothing_.margin());
  const auto length = static_cast<std::size_t>(smoothing_.length());
  thread_local std::vector<float> real, imaginary, ratios, smooth, coarse;
  ratios.assign(length + 2 * margin, 1.0f);
  smooth.resize(length);
  float* ratio = ratios.data() + margin;
  const float scale = heldWhite(white);
  for (int i = 0; i < lines_; ++i) {
    const std::size_t first = static_cast<std::size_t>(i) * samples;
    const auto copied = [&](const std::vector<float>& plane, std::vector<float>& to) {
      if (field.empty())
        to.assign(samples, 0.0f);
      else
        to.assign(plane.begin() + static_cast<std::ptrdiff_t>(first),
                  plane.begin() + static_cast<std::ptrdiff_t>(first + samples));
    };
    copied(field.real, real);
    copied(field.imaginary, imaginary);
    if (clutter_) clutter_->add(white, i, real.data(), imaginary.data());
    if (noise_) noise_->add(white, time_s, i, real.data(), imaginary.data());
    const float* mean = field.empty() ? nullptr : field.mean.data() + first;
    const auto total = [&](std::size_t k) { return (mean ? mean[k] : 0) + scale * levels_[k]; };
    for (std::size_t k = 0; k < samples; ++k) {
      const float of = total(k);
      ratio[k] = of > 0 ? (real[k] * real[k] + imaginary[k] * imaginary[k]) / of : 1;
    }
    smoothing_.apply(ratio, coarse, smooth.data());
    float* to = intensities.data() + first;
    for (std::size_t k = 0; k < samples; ++k) to[k] = (mean ? 0 : to[k]) + total(k) * smooth[k];
  }
}

}  // namespace echocine
