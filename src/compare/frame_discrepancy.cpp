#include "compare/frame_discrepancy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/check.h"
#include "core/error.h"
#include "echo/read_loop.h"
#include "echo/resample.h"

namespace echocine::compare {

// Weights are areas on the grid; a placement of scale s covers s^2 as much of the real picture.
double overlapShare(std::span<const float> weights_as_given, std::span<const float> weights,
                    double scale) {
  const double before = std::accumulate(weights_as_given.begin(), weights_as_given.end(), 0.0),
               after = std::accumulate(weights.begin(), weights.end(), 0.0);
  return before > 0 ? std::min(1.0, scale * scale * after / before) : 0;
}

FrameDiscrepancy::FrameDiscrepancy(const echo::EchoLoop& real, const Probe& probe,
                                   const echo::Placement& placement)
    : probe_(probe) {
  if (!real.metres_per_pixel)
    throw SceneError(
        fmt::format("{}: has no length scale; give --scale in mm per pixel", real.video.name));
  echo::checkScale(real);
  if (!probe.isSector() || probe.lines < 8 || probe.samples < 16)
    throw SceneError("the discrepancy needs a sector of at least 8 lines and 16 samples");
  // After smoothing over 2 % of the depth there are fewer than a hundred independent depths, so
  // 384 samples lose no information and keep a call short. Our choice.
  constexpr int kMostSamples = 384;
  per_sample_ = (probe.samples + kMostSamples - 1) / kMostSamples;
  grid_.metric = true;
  grid_.lines = probe.lines;
  grid_.samples = probe.samples / per_sample_;
  grid_.first_rad = probe.first_angle_rad;
  grid_.last_rad = probe.last_angle_rad;
  grid_.near = probe.face_radius_m + probe.min_depth_m;
  grid_.far = grid_.near + probe.sampleSpacing() * per_sample_ * grid_.samples;
  const echo::BeamLoop beams = echo::resample(grid_, real, placement);
  const std::vector<float> weights = echo::areaWeights(grid_, beams.valid, beams.valid);
  const auto seen = std::count_if(weights.begin(), weights.end(), [](float w) { return w > 0; });
  // A fifth, our choice: a smaller part does not identify the heart.
  if (static_cast<double>(seen) < 0.2 * static_cast<double>(weights.size()))
    throw SceneError(
        fmt::format("{}: shows less than a fifth of the probe's sector; give a loop of the "
                    "same view",
                    real.video.name));
  const PixelPlane as_given = echo::validSamples(grid_, real, {});
  overlap_ =
      compare::overlapShare(echo::areaWeights(grid_, as_given, as_given), weights, placement.scale);
  // All that depends on the real loop alone is worked out here, so that a call looks at one frame
  // only.
  edges_.emplace(grid_, weights);
  for (const std::vector<float>& frame : beams.frames) real_.push_back((*edges_)(frame));
}

double FrameDiscrepancy::operator()(int frame, std::span<const float> grey) const {
  CHECK_EQ(grey.size(),
           static_cast<std::size_t>(probe_.lines) * static_cast<std::size_t>(probe_.samples));
  // Means of neighbouring samples: subsampling would let single bright samples through.
  std::vector<float> means;  // of per_sample_ samples, 0 to 255
  means.reserve(grid_.size());
  const float scale = 255.0f / static_cast<float>(per_sample_);
  for (int i = 0; i < grid_.lines; ++i) {
    const float* line = grey.data() + static_cast<std::ptrdiff_t>(i) * probe_.samples;
    for (int k = 0; k < grid_.samples; ++k) {
      float sum = 0;
      for (int s = 0; s < per_sample_; ++s) sum += line[k * per_sample_ + s];
      means.push_back(scale * sum);
    }
  }
  return discrepancyOf(edgeCorrelation((*edges_)(means), real_.at(static_cast<std::size_t>(frame))),
                       overlap_);
}

}  // namespace echocine::compare
