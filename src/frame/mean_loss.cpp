#include "frame/mean_loss.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/free_list.h"
#include "core/parallel.h"
#include "geometry/plane_slice.h"
#include "trace/trace_frame.h"

namespace echocine {

namespace {

constexpr int kMeanPhases =
    16;  // our choice: the heart moves less between two than its walls are thick
constexpr double kLeast = 1e-20, kNone = -1;

// The factor of attenuation at each sample of a phase; kNone where no medium is. Thread-safe.
class LossTracer {
 public:
  LossTracer(const Scene& scene, const MeshMotion& motion, const LoopPlan& plan)
      : scene_(scene), motion_(motion), plan_(plan), settings_(scene, straight(plan.effects)) {
    request_.channels = {Channel::attenuation, Channel::medium};
    request_.intensities = false;
  }

  std::vector<double> leftAt(double phase) const {
    const std::shared_ptr<Space> space = spaces_.borrow([&] {
      return std::make_unique<Space>(
          Space{PlaneSlice(motion_.surfaces(), scene_.probe, plan_.left_out), {}, {}});
    });
    motion_.frameAt(phase, space->surfaces, false);
    space->slice.update(space->surfaces);
    traceFrame(space->slice, scene_.probe, settings_, request_, space->frame);
    const PolarFrame& frame = space->frame;
    const std::vector<float>& exponents = frame.planes.at(Channel::attenuation);
    std::vector<double> left(exponents.size(), kNone);
    for (std::size_t at = 0; at < left.size(); ++at)
      if (frame.medium[at] != kNoMedium) left[at] = std::exp(-static_cast<double>(exponents[at]));
    return left;
  }

 private:
  struct Space {
    PlaneSlice slice;
    SurfaceFrame surfaces;
    PolarFrame frame;
  };
  static EffectPlan straight(EffectPlan effects) {
    effects.refraction = false;
    return effects;
  }

  const Scene& scene_;
  const MeshMotion& motion_;
  const LoopPlan& plan_;
  const TraceSettings settings_;
  PlaneRequest request_;
  mutable FreeList<Space> spaces_;
};

}  // namespace

std::vector<double> meanLoss(const Scene& scene, const MeshMotion& motion, const LoopPlan& plan) {
  const LossTracer tracer(scene, motion, plan);
  const auto samples = static_cast<std::size_t>(scene.probe.samples);
  std::vector<double> sums(samples), counts(samples);
  const auto trace = [&](std::size_t i) -> std::shared_ptr<void> {
    return std::make_shared<std::vector<double>>(
        tracer.leftAt(static_cast<double>(i) / kMeanPhases));
  };
  // In the order of the phases: the sums do not depend on the threads.
  const auto add = [&](std::size_t, const std::shared_ptr<void>& traced) {
    const auto& left = *static_cast<const std::vector<double>*>(traced.get());
    for (std::size_t at = 0; at < left.size(); ++at) {
      if (left[at] == kNone) continue;
      sums[at % samples] += left[at];
      counts[at % samples] += 1;
    }
  };
  parallelOrdered(
      0, kMeanPhases, static_cast<std::size_t>(threadCount()), [] { return true; }, trace, add);
  std::vector<double> loss(samples);
  double last = 1;
  for (std::size_t k = 0; k < samples; ++k) {
    if (counts[k] > 0) last = std::clamp(sums[k] / counts[k], kLeast, last);
    loss[k] = last;
  }
  return loss;
}

}  // namespace echocine
