#include "compare/model_discrepancy.h"

#include <algorithm>
#include <cmath>

#include "compare/descent.h"
#include "compare/registration.h"
#include "core/check.h"
#include "core/parallel.h"
#include "simulate/simulator.h"

namespace echocine::compare {

namespace {

// End-diastole as user or file have it; nothing where neither does.
std::optional<double> knownStart(const Loop& real, const SideOptions& side, std::string& source) {
  if (side.ed_frame) {
    source = "given";
    return *side.ed_frame;
  }
  const Video& v = real.video;
  if (!v.r_waves_s.empty() && v.rate.hz > 0 &&
      v.r_waves_s.front() * v.rate.hz < v.frameCount() - 1) {
    source = "R waves";
    return v.r_waves_s.front() * v.rate.hz;
  }
  for (const auto& [name, ml] : real.volumes_ml)
    if (name == real.lv_cavity && !ml.empty()) {
      source = "manifest";
      const auto beat = std::min<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(ml.size()),
                                                 std::lround(std::max(1.0, real.frames_per_beat)));
      return static_cast<double>(std::max_element(ml.begin(), ml.begin() + beat) - ml.begin());
    }
  return std::nullopt;
}

}  // namespace

ModelDiscrepancy::ModelDiscrepancy(const Loop& real, const SideOptions& side,
                                   const ModelLoop& first, const FitSettings& settings)
    : settings_(settings) {
  CHECK_EQ(first.frames.size(), static_cast<std::size_t>(kFitFrames));
  if (!real.metres_per_pixel) settings_.limits.scale_free = true;
  const BeatLength length = beatOf(real);
  beat_.span.frames = length.frames;
  beat_.length_source = length.source;
  if (!(length.frames > 0)) {
    beat_.span.frames = real.video.frameCount();
    beat_.length_source = "the loop is taken for a beat";
  }
  const std::optional<double> start = knownStart(real, side, beat_.start_source);
  beat_.span.end_diastole = start.value_or(0);
  stack_.emplace(real, beat_.span, kFitFrames, first.far_m);
  if (!start) findStart(real, first);
}

// Pose and start depend on each other little: walls stand about where they stand at any time. So
// one is sought with the other held, twice.
void ModelDiscrepancy::findStart(const Loop& real, const ModelLoop& first) {
  PoseFound found = search(first);
  std::vector<double> values(kFitFrames);
  int best = 0;
  for (int round = 0; round < 2; ++round) {
    parallelBlocks(values.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        FitPose pose = found.pose;
        pose.lag = static_cast<int>(i);
        values[i] = at(first, pose).discrepancy;
      }
    });
    best = static_cast<int>(std::min_element(values.begin(), values.end()) - values.begin());
    FitPose start = found.pose;
    start.lag = best;
    if (round == 0) found = refine(first, {start});
  }
  const auto value = [&](int lag) {
    return values[static_cast<std::size_t>((lag + kFitFrames) % kFitFrames)];
  };
  // A parabola through the best and its neighbours; rivals stand an eighth of a beat away or more.
  const double before = value(best - 1), here = value(best), after = value(best + 1),
               bend = before - 2 * here + after;
  const double part = bend > 0 ? 0.5 * (before - after) / bend : 0;
  double rival = 2;
  for (int lag = 3; lag <= kFitFrames - 3; ++lag) rival = std::min(rival, value(best + lag));
  std::vector<double> sorted = values;
  std::nth_element(sorted.begin(), sorted.begin() + kFitFrames / 2, sorted.end());
  const double median = sorted[kFitFrames / 2];
  beat_.confidence = standsOut(here, rival, median);
  beat_.start_source = "the model's beat";
  beat_.span.end_diastole = (best + part) / kFitFrames * beat_.span.frames;
  stack_.emplace(real, beat_.span, kFitFrames, first.far_m);
}

PoseFound ModelDiscrepancy::search(const ModelLoop& model) const {
  return searchPose(model, *stack_, settings_.weights, settings_.limits);
}

PoseFound ModelDiscrepancy::refine(const ModelLoop& model,
                                   const std::vector<FitPose>& starts) const {
  return refinePose(model, *stack_, settings_.weights, settings_.limits, starts);
}

PoseFound ModelDiscrepancy::search(const Simulator& model) const {
  return search(modelLoop(model.scene(), model.motion(), kFitFrames));
}

PoseFound ModelDiscrepancy::at(const ModelLoop& model, const FitPose& pose) const {
  PoseFound out;
  out.pose = pose;
  out.terms = fitTerms(model, *stack_, pose);
  out.discrepancy = fitDiscrepancy(out.terms, settings_.weights);
  return out;
}

FitMap ModelDiscrepancy::map(const ModelLoop& model, const FitPose& pose) const {
  return fitMap(model, *stack_, pose);
}

}  // namespace echocine::compare
