#include "fit/model_discrepancy.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "core/error.h"
#include "core/parallel.h"
#include "echo/beat_length.h"
#include "echo/r_wave_beats.h"
#include "fit/descent.h"
#include "fit/dial_checks.h"
#include "frame/simulator.h"

namespace echocine::fit {

namespace {

// End-diastole as user or file have it; nothing where neither does.
std::optional<double> knownStart(const echo::EchoLoop& real, const echo::SideOptions& side,
                                 std::string& source) {
  if (side.ed_frame) {
    source = "given";
    return *side.ed_frame;
  }
  const std::vector<double> waves = real.rWaveFrames();
  if (!waves.empty() && waves.front() < real.video.frameCount() - 1) {
    source = real.ecg ? real.beat_anchor : "R waves";
    return waves.front();
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

ModelDiscrepancy::ModelDiscrepancy(const echo::EchoLoop& real, const echo::SideOptions& side,
                                   const ModelLoop& first, const FitSettings& settings)
    : settings_(settings) {
  CHECK_EQ(first.frames.size(), static_cast<std::size_t>(kFitFrames));
  checkWeights(settings.weights);
  echo::checkSide(side);
  echo::checkScale(real);
  if (!real.metres_per_pixel) settings_.limits.scale_free = true;
  const echo::BeatLength length = echo::beatOf(real);
  beat_.span.frames = length.frames;
  beat_.length_source = length.source;
  if (!(length.frames > 0)) {
    beat_.span.frames = real.video.frameCount();
    beat_.length_source = kLoopIsBeat;
  }
  const std::optional<double> start = knownStart(real, side, beat_.start_source);
  beat_.span.end_diastole = start.value_or(0);
  if (real.ecg && !side.ed_frame) {  // not an early beat, where the trace shows a usual one
    beat_.confidence = real.ecg->confidence;
    echo::EcgTrace trace = *real.ecg;
    trace.beat_frames = length.frames;
    const auto beat = echo::usualBeat(trace, real.video.frameCount());
    if (beat && beat_.length_source == real.beat_anchor)
      beat_.span = {.end_diastole = beat->r_frame,
                    .frames = beat->frames / echo::beatsBetween(beat->frames, length.frames),
                    .systole = 0,
                    .shown_systole = 0};
  }
  stack_.emplace(real, beat_.span, kFitFrames, first.far_m);
  if (!start) findStart(real, first);
  findSystole(real, side, first);
}

// The pose hardly depends on it, so one is sought with the other held, twice.
void ModelDiscrepancy::findSystole(const echo::EchoLoop& real, const echo::SideOptions& side,
                                   const ModelLoop& first) {
  if (!(first.systole > 0)) return;
  // Parts of a beat at which systole ends, at 30 to 200 beats a minute and beyond. Our choice.
  constexpr double kEarliest = 0.15, kLatest = 0.70, kStep = 0.0125, kApart = 0.15;
  beat_.span.shown_systole = first.systole;
  if (side.es_frame) {
    const double beats = (*side.es_frame - beat_.span.end_diastole) / beat_.span.frames;
    beat_.span.systole = beats - std::floor(beats);
    beat_.systole_source = "given";
    if (!(beat_.span.systole >= kEarliest && beat_.span.systole <= kLatest))
      throw SceneError(fmt::format(
          "end-systole: frame {:g} lies at {:.2f} of the beat from end-diastole, accepted: {:g} to "
          "{:g}; give another frame for it, or for end-diastole",
          *side.es_frame, beat_.span.systole, kEarliest, kLatest));
  } else {
    FitPose pose = search(first).pose;
    std::vector<double> values(
        static_cast<std::size_t>(std::lround((kLatest - kEarliest) / kStep)) + 1);
    std::ptrdiff_t best = 0;
    for (int round = 0; round < 2; ++round) {
      parallelBlocks(values.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          FitPose held = pose;
          held.systole = kEarliest + kStep * static_cast<double>(i);
          values[i] = at(first, held).discrepancy;
        }
      });
      best = std::min_element(values.begin(), values.end()) - values.begin();
      pose.systole = kEarliest + kStep * static_cast<double>(best);
      if (round == 0) pose = refine(first, {pose}).pose;
    }
    const auto value = [&](std::ptrdiff_t i) {
      return values[static_cast<std::size_t>(
          std::clamp(i, std::ptrdiff_t{0}, static_cast<std::ptrdiff_t>(values.size()) - 1))];
    };
    const double before = value(best - 1), here = value(best), after = value(best + 1),
                 bend = before - 2 * here + after;
    beat_.span.systole =
        pose.systole +
        (bend > 0 ? kStep * std::clamp(0.5 * (before - after) / bend, -1.0, 1.0) : 0);
    double rival = 2;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (std::abs(kStep * (static_cast<double>(i) - static_cast<double>(best))) >= kApart)
        rival = std::min(rival, values[i]);
    std::vector<double> sorted = values;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    beat_.systole_source = "the model's beat";
    beat_.systole_confidence = confidenceOf(here, rival, *middle);
  }
  stack_.emplace(real, beat_.span, kFitFrames, first.far_m);
}

// Pose and start depend little on each other: walls move little over the beat. So
// one is sought with the other held, twice.
void ModelDiscrepancy::findStart(const echo::EchoLoop& real, const ModelLoop& first) {
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
  beat_.confidence = confidenceOf(here, rival, median);
  beat_.start_source = "the model's beat";
  beat_.span.end_diastole = (best + part) / kFitFrames * beat_.span.frames;
  stack_.emplace(real, beat_.span, kFitFrames, first.far_m);
}

PoseFound ModelDiscrepancy::search(const ModelLoop& model) const {
  return searchPose(model, *stack_, settings_.weights, settings_.limits);
}

PoseFound ModelDiscrepancy::refine(const ModelLoop& model,
                                   const std::vector<FitPose>& starts) const {
  checkStarts(starts);
  return refinePose(model, *stack_, settings_.weights, settings_.limits, starts);
}

PoseFound ModelDiscrepancy::searchAlsoFrom(const ModelLoop& model,
                                           const std::vector<FitPose>& starts) const {
  checkStarts(starts);
  return searchPose(model, *stack_, settings_.weights, settings_.limits, starts);
}

PoseFound ModelDiscrepancy::search(const Simulator& model) const {
  return search(modelLoop(model.scene(), model.motion(), kFitFrames));
}

PoseFound ModelDiscrepancy::at(const ModelLoop& model, const FitPose& pose) const {
  checkPose(pose);
  PoseFound out;
  out.pose = pose;
  out.terms = fitTerms(model, *stack_, pose);
  out.discrepancy = fitDiscrepancy(out.terms, settings_.weights);
  return out;
}

std::vector<FitTerms> ModelDiscrepancy::terms(const ModelLoop& model,
                                              const std::vector<FitPose>& poses) const {
  for (const FitPose& pose : poses) checkPose(pose);
  constexpr std::size_t kTogether = 8;  // poses that share the reading of a picture; our choice
  std::vector<FitTerms> out(poses.size());
  parallelBlocks(poses.size(), kTogether, [&](std::size_t begin, std::size_t end) {
    for (std::size_t first = begin, last = begin; first < end; first = last) {
      while (last < end && poses[last].lag == poses[first].lag &&
             poses[last].systole == poses[first].systole)
        ++last;
      const std::vector<FitTerms> some = PlacedBeat(model, *stack_, poses[first])
                                             .terms(std::span(poses).subspan(first, last - first));
      std::copy(some.begin(), some.end(), out.begin() + static_cast<std::ptrdiff_t>(first));
    }
  });
  return out;
}

ModelDiscrepancy ModelDiscrepancy::without(int first, int end) const {
  ModelDiscrepancy out = *this;
  out.stack_->hide(first, end);
  return out;
}

FitMap ModelDiscrepancy::map(const ModelLoop& model, const FitPose& pose) const {
  return fitMap(model, *stack_, pose);
}

}  // namespace echocine::fit
