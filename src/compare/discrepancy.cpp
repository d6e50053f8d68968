#include "compare/discrepancy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

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

Smoother::Smoother(const BeamGrid& g, std::span<const float> weights)
    : lines_(g.lines), samples_(g.samples) {
  const double sigma = kSmoothingShare * g.far;
  along_ = sigma / ((g.far - g.near) / g.samples);
  const double line = (g.last_rad - g.first_rad) / std::max(1, g.lines - 1) * (g.near + g.far) / 2;
  across_ = sigma / line;
  mask_.assign(weights.size(), 0);
  for (std::size_t i = 0; i < mask_.size(); ++i) mask_[i] = weights[i] > 0 ? 1.0f : 0.0f;
  const std::vector<float> mask = mask_;
  share_.assign(mask_.size(), 1);
  share_ = (*this)(mask);
  for (float& s : share_) s = std::max(s, 1e-6f);
}

std::vector<float> Smoother::operator()(std::span<const float> frame) const {
  std::vector<float> out(frame.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = frame[i] * mask_[i];
  cv::Mat m(lines_, samples_, CV_32F, out.data());
  cv::GaussianBlur(m, m, {0, 0}, along_, across_, cv::BORDER_CONSTANT);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = mask_[i] > 0 ? out[i] / share_[i] : 0;
  return out;
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
  smoother_.emplace(grid_, weights_);
  for (std::vector<float>& frame : real_.frames) frame = (*smoother_)(frame);
  deviation_ = loopDeviation(real_.frames, weights_);
}

// Means of per_sample_ samples, 0 to 255, smoothed.
std::vector<float> Discrepancy::smoothed(std::span<const float> grey) const {
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
  return (*smoother_)(out);
}

void Discrepancy::calibrate(const std::vector<std::pair<int, std::vector<float>>>& pairs) {
  std::vector<std::vector<float>> frames;
  std::vector<const std::vector<float>*> all;
  for (const auto& pair : pairs) frames.push_back(smoothed(pair.second));
  for (const auto& frame : frames) all.push_back(&frame);
  CalibrationFit fit(quantileKnots(all, weights_, knots_));
  for (std::size_t i = 0; i < pairs.size(); ++i)
    fit.add(frames[i], real_.frames[static_cast<std::size_t>(pairs[i].first)], weights_);
  curve_ = fit.solve(false);
}

double Discrepancy::operator()(int frame, std::span<const float> grey) const {
  const std::vector<float>& real = real_.frames.at(static_cast<std::size_t>(frame));
  std::vector<float> x = smoothed(grey);
  if (curve_.knots.empty()) {
    const std::vector<float>* one[] = {&x};
    CalibrationFit fit(quantileKnots(one, weights_, knots_));
    fit.add(x, real, weights_);
    fit.solve(false).apply(x, x);
  } else {
    curve_.apply(x, x);
  }
  const BeamPair pair{x, real, weights_, grid_.lines, grid_.samples};
  return discrepancyOf(rmsDifference(pair), deviation_, gradientCorrelation(pair));
}

}  // namespace echocine::compare
