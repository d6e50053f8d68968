#include "frame/mean_loss.h"

#include <algorithm>
#include <cmath>

#include "geometry/plane_slice.h"
#include "trace/trace_frame.h"

namespace echocine {

std::vector<double> meanLoss(const Scene& scene, const MeshMotion& motion, const LoopPlan& plan) {
  constexpr int kPhases =
      16;  // our choice: the heart moves less between two than its walls are thick
  constexpr double kLeast = 1e-20;
  EffectPlan effects = plan.effects;
  effects.refraction = false;
  const TraceSettings settings(scene, effects);
  PlaneRequest request;
  request.channels = {Channel::attenuation, Channel::medium};
  request.intensities = false;
  const auto samples = static_cast<std::size_t>(scene.probe.samples);
  std::vector<double> sums(samples), counts(samples);
  PlaneSlice slice(motion.surfaces(), scene.probe, plan.left_out);
  SurfaceFrame surfaces;
  PolarFrame frame;
  for (int i = 0; i < kPhases; ++i) {
    motion.frameAt(static_cast<double>(i) / kPhases, surfaces, false);
    slice.update(surfaces);
    traceFrame(slice, scene.probe, settings, request, frame);
    const std::vector<float>& exponents = frame.planes.at(Channel::attenuation);
    for (std::size_t at = 0; at < exponents.size(); ++at) {
      if (frame.medium[at] == kNoMedium) continue;
      sums[at % samples] += std::exp(-static_cast<double>(exponents[at]));
      counts[at % samples] += 1;
    }
  }
  std::vector<double> loss(samples);
  double last = 1;
  for (std::size_t k = 0; k < samples; ++k) {
    if (counts[k] > 0) last = std::clamp(sums[k] / counts[k], kLeast, last);
    loss[k] = last;
  }
  return loss;
}

}  // namespace echocine
