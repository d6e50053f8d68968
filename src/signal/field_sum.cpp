#include "signal/field_sum.h"

#include <algorithm>

#include "core/lanes.h"
#include "core/parallel.h"
#include "speckle/point_spread.h"

namespace echocine {

FieldSum::FieldSum(const Scene& scene, const EffectPlan& plan, std::span<const float> gains)
    : lines_(scene.probe.lines),
      samples_(scene.probe.samples),
      smoothing_(samples_, scene.speckle.smoothing_m / kWidthAtHalf / scene.probe.sampleSpacing()) {
  if (plan.noise) levels_ = noiseLevels(scene, gains);
  if (plan.clutter) {
    levels_.resize(static_cast<std::size_t>(samples_));
    const std::vector<float> clutter = clutterLevels(scene, plan.harmonic, plan.clutter_window_db);
    for (std::size_t k = 0; k < clutter.size(); ++k) levels_[k] += clutter[k];
  }
  if (plan.averaged) return;
  if (plan.clutter) clutter_.emplace(scene, plan.harmonic, plan.clutter_window_db);
  if (plan.noise) noise_.emplace(scene, gains);
}

void FieldSum::addMean(double white, std::span<float> intensities) const {
  const float scale = heldWhite(white);
  const auto samples = static_cast<std::size_t>(samples_);
  for (std::size_t i = 0; i < intensities.size(); ++i)
    intensities[i] += scale * levels_[i % samples];
}

// Memory of a line in the making.
struct FieldSum::Line {
  std::vector<float> real, imaginary, total, ratios, smooth, coarse;
};

void FieldSum::add(double white, double time_s, const EchoField& field,
                   std::span<float> intensities) const {
  if (!adds()) return;
  if (!draws()) return addMean(white, intensities);
  constexpr std::size_t kAtOnce = 8;  // lines. Our choice, by time
  parallelBlocks(static_cast<std::size_t>(lines_), kAtOnce,
                 [&](std::size_t begin, std::size_t end) {
                   thread_local Line line;
                   for (std::size_t i = begin; i < end; ++i)
                     addLine(white, time_s, static_cast<int>(i), field, line, intensities);
                 });
}

void FieldSum::addDrawn(double white, double time_s, int number, float* real,
                        float* imaginary) const {
  if (clutter_) clutter_->add(white, time_s, number, real, imaginary);
  if (noise_) noise_->add(white, time_s, number, real, imaginary);
}

// Lines are padded: noise comes in whole lanes.
void FieldSum::addTo(EchoField& field, double white, double time_s, LineRange lines) const {
  if (!draws()) return;
  const auto samples = static_cast<std::size_t>(samples_);
  const auto length = static_cast<std::size_t>(smoothing_.length());
  parallelBlocks(static_cast<std::size_t>(lines.count()), 8,
                 [&](std::size_t begin, std::size_t end) {
                   std::vector<float> real, imaginary;
                   for (std::size_t i = begin; i < end; ++i) {
                     const int number = lines.first + static_cast<int>(i);
                     const std::size_t first = static_cast<std::size_t>(number) * samples;
                     real.assign(length, 0.0f);
                     imaginary.assign(length, 0.0f);
                     addDrawn(white, time_s, number, real.data(), imaginary.data());
                     for (std::size_t k = 0; k < samples; ++k) {
                       field.real[first + k] += real[k];
                       field.imaginary[first + k] += imaginary[k];
                     }
                   }
                 });
}

void FieldSum::addLine(double white, double time_s, int number, const EchoField& field, Line& line,
                       std::span<float> intensities) const {
  const auto samples = static_cast<std::size_t>(samples_);
  const std::size_t first = static_cast<std::size_t>(number) * samples;
  const auto length = static_cast<std::size_t>(smoothing_.length());
  const auto copied = [&](const std::vector<float>& plane, std::vector<float>& to) {
    to.resize(length);
    const std::size_t count = field.empty() ? 0 : samples;
    std::copy_n(plane.data() + (field.empty() ? 0 : first), count, to.data());
    std::fill(to.begin() + static_cast<std::ptrdiff_t>(count), to.end(), 0.0f);
  };
  copied(field.real, line.real);
  copied(field.imaginary, line.imaginary);
  copied(field.mean, line.total);
  addDrawn(white, time_s, number, line.real.data(), line.imaginary.data());
  const auto margin = static_cast<std::size_t>(smoothing_.margin());
  line.ratios.resize(length + 2 * margin);
  line.smooth.resize(length);
  float* const ratio = line.ratios.data() + margin;
  const Floats8 scale = Floats8{} + heldWhite(white), one = Floats8{} + 1;
  for (std::size_t k = 0; k < samples; k += kFloatLanes) {
    const std::size_t left = samples - k;
    const Floats8 total = lanesAt(&line.total[k]) + scale * someLanesAt(&levels_[k], left);
    const Floats8 re = lanesAt(&line.real[k]), im = lanesAt(&line.imaginary[k]);
    const Ints8 some = total > 0;
    const Floats8 of = (re * re + im * im) / (some ? total : one);
    store(total, &line.total[k]);
    storeSome(some ? of : one, left, ratio + k);
  }
  smoothing_.apply(ratio, line.coarse, line.smooth.data());
  float* const to = intensities.data() + first;
  for (std::size_t k = 0; k < samples; ++k)
    to[k] = (field.empty() ? to[k] : 0) + line.total[k] * line.smooth[k];
}

}  // namespace echocine
