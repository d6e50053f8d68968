#include "compare/discrepancy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/metrics.h"
#include "core/check.h"
#include "core/error.h"

namespace echocine::compare {

double discrepancyOf(double rms, double real_deviation, double gradient_correlation) {
  const double unexplained = real_deviation > 0 ? rms / real_deviation : rms > 0 ? 1 : 0;
  return 0.5 * unexplained + 0.5 * (1 - gradient_correlation);
}

double loopDeviation(const std::vector<std::vector<float>>& frames,
                     std::span<const float> weights) {
  double n = 0, sum = 0, squares = 0;
  for (const std::vector<float>& frame : frames)
    for (std::size_t i = 0; i < frame.size(); ++i) {
      const double w = weights[i], g = frame[i];
      n += w, sum += w * g, squares += w * g * g;
    }
  return n > 0 ? std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n))) : 0;
}

Discrepancy::Discrepancy(const Loop& real, const Probe& probe, const Placement& placement,
                         int knots)
    : probe_(probe), knots_(knots) {
  if (!real.metres_per_pixel)
    throw SceneError(
        fmt::format("{}: has no length scale; give --scale in mm per pixel", real.video.name));
  if (probe.kind == ProbeKind::linear || probe.lines < 8 || probe.samples < 16)
    throw SceneError("the discrepancy needs a sector of at least 8 lines and 16 samples");
  constexpr int kMostSamples = 384;
  per_sample_ = (probe.samples + kMostSamples - 1) / kMostSamples;
  grid_.metric = true;
  grid_.lines = probe.lines;
  grid_.samples = probe.samples / per_sample_;
  grid_.first_rad = probe.first_angle_rad;
  grid_.last_rad = probe.last_angle_rad;
  grid_.near = probe.face_radius_m + probe.min_depth_m;
  grid_.far = grid_.near + probe.sampleSpacing() * per_sample_ * grid_.samples;
  real_ = resample(grid_, real, placement);
  weights_ = areaWeights(grid_, real_.valid, real_.valid);
  const auto seen = std::count_if(weights_.begin(), weights_.end(), [](float w) { return w > 0; });
  if (static_cast<double>(seen) < 0.2 * static_cast<double>(weights_.size()))
    throw SceneError(
        fmt::format("{}: shows less than a fifth of the probe's sector; give a loop of the "
                    "same view",
                    real.video.name));
  deviation_ = loopDeviation(real_.frames, weights_);
}

// Means of per_sample_ samples, 0 to 255.
std::vector<float> Discrepancy::reduced(std::span<const float> grey) const {
  CHECK_EQ(grey.size(),
           static_cast<std::size_t>(probe_.lines) * static_cast<std::size_t>(probe_.samples));
  std::vector<float> out;
  out.reserve(grid_.size());
  const float scale = 255.0f / static_cast<float>(per_sample_);
  for (int i = 0; i < grid_.lines; ++i) {
    const float* line = grey.data() + static_cast<std::ptrdiff_t>(i) * probe_.samples;
    for (int k = 0; k < grid_.samples; ++k) {
      float sum = 0;
      for (int s = 0; s < per_sample_; ++s) sum += line[k * per_sample_ + s];
      out.push_back(scale * sum);
    }
  }
  return out;
}

void Discrepancy::calibrate(const std::vector<std::pair<int, std::vector<float>>>& pairs) {
  std::vector<std::vector<float>> frames;
  std::vector<const std::vector<float>*> all;
  for (const auto& pair : pairs) frames.push_back(reduced(pair.second));
  for (const auto& frame : frames) all.push_back(&frame);
  CalibrationFit fit(quantileKnots(all, weights_, knots_));
  for (std::size_t i = 0; i < pairs.size(); ++i)
    fit.add(frames[i], real_.frames[static_cast<std::size_t>(pairs[i].first)], weights_);
  curve_ = fit.solve(false);
}

double Discrepancy::operator()(int frame, std::span<const float> grey) const {
  const std::vector<float>& real = real_.frames.at(static_cast<std::size_t>(frame));
  std::vector<float> x = reduced(grey);
  if (curve_.knots.empty()) {
    const std::vector<float>* one[] = {&x};
    CalibrationFit fit(quantileKnots(one, weights_, knots_));
    fit.add(x, real, weights_);
    fit.solve(false).apply(x, x);
  } else {
    curve_.apply(x, x);
  }
  double n = 0, squares = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double d = static_cast<double>(x[i]) - real[i];
    n += weights_[i];
    squares += weights_[i] * d * d;
  }
  const double correlation = gradientCorrelation({x, real, weights_, grid_.lines, grid_.samples});
  return discrepancyOf(n > 0 ? std::sqrt(squares / n) : 0, deviation_, correlation);
}

}  // namespace echocine::compare
