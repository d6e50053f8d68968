// The page that shows the comparison: read -> common beam space -> beat -> time -> space -> greys
// -> metrics.

#include "compare/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "compare/boundary_bands.h"
#include "compare/registration.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/shown_path.h"
#include "fit/fit_report.h"
#include "scene/scene_reader.h"

namespace echocine::compare {

namespace {

// The curve of the whole loop, from counted frames.
GreyCurve fitCurve(const CompareOptions& options, const std::vector<std::vector<float>>& synthetic,
                   const std::vector<std::vector<float>>& real, const Comparison& c) {
  std::vector<const std::vector<float>*> used;
  for (std::size_t j = 0; j < synthetic.size(); ++j)
    if (c.frames[j].counted()) used.push_back(&synthetic[j]);
  if (used.empty())
    throw SceneError(fmt::format("{} and {} share no instant of the beat; give longer loops",
                                 c.synthetic.video.name, c.real.video.name));
  CalibrationFit fit(options.knots.empty() ? quantileKnots(used, c.weights, options.knot_count)
                                           : options.knots);
  for (std::size_t j = 0; j < synthetic.size(); ++j)
    if (c.frames[j].counted()) fit.add(synthetic[j], real[j], c.weights);
  return fit.solve(options.monotone);
}

// Over counted frames.
FrameMetrics meanOf(const std::vector<FrameResult>& frames,
                    const std::function<const FrameMetrics&(const FrameResult&)>& pick) {
  std::vector<FrameMetrics> counted;
  for (const FrameResult& f : frames)
    if (f.counted()) counted.push_back(pick(f));
  return loopMetrics(counted);
}

void measureFrames(const std::vector<std::vector<float>>& paired, const BoundaryBands* bands,
                   Comparison& c) {
  parallelBlocks(c.frames.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      FrameResult& f = c.frames[j];
      if (f.synthetic_place < 0) continue;
      const std::vector<float>& real = c.real_beams.frames[j];
      std::vector<float> fitted(paired[j].size());
      c.curve.apply(paired[j], fitted);
      f.before = frameMetrics({paired[j], real, c.weights, c.grid.lines, c.grid.samples});
      f.after = frameMetrics({fitted, real, c.weights, c.grid.lines, c.grid.samples});
      if (bands == nullptr) continue;
      for (const auto& [name, weights] : bands->weightsAt(f.synthetic_phase, c.weights))
        f.bands.push_back(
            {name, frameMetrics({fitted, real, weights, c.grid.lines, c.grid.samples})});
    }
  });
}

void summarise(Comparison& c) {
  c.mean_before =
      meanOf(c.frames, [](const FrameResult& f) -> const FrameMetrics& { return f.before; });
  c.mean_after =
      meanOf(c.frames, [](const FrameResult& f) -> const FrameMetrics& { return f.after; });
  const auto with_bands = std::find_if(c.frames.begin(), c.frames.end(),
                                       [](const FrameResult& f) { return !f.bands.empty(); });
  if (with_bands == c.frames.end()) return;
  for (std::size_t b = 0; b < with_bands->bands.size(); ++b)
    c.mean_bands.push_back({with_bands->bands[b].structure,
                            meanOf(c.frames, [b](const FrameResult& f) -> const FrameMetrics& {
                              static const FrameMetrics kNone;
                              return b < f.bands.size() ? f.bands[b].metrics : kNone;
                            })});
}

// Reading each loop, laying them on one another, calibrating, measuring.
class Steps {
 public:
  explicit Steps(const Monitor& monitor) : monitor_(monitor) {}
  // Throws JobError when the monitor wants to stop.
  void next() {
    if (!monitor_.keep_going()) throw JobError("stopped while loops were compared");
    monitor_.tell({Task::comparing, ++done_, kSteps});
  }

 private:
  static constexpr std::size_t kSteps = 5;
  const Monitor& monitor_;
  std::size_t done_ = 0;
};

// Loops of the same beat reach 0.3 and more. Our choice.
constexpr double kDoubtfulConfidence = 0.1;

void noteAssumptions(Comparison& c) {
  const auto say = [&](const std::string& note) { c.notes.push_back(note); };
  for (const echo::EchoLoop* loop : {&c.synthetic, &c.real})
    for (const std::string& note : loop->video.notes) say(loop->label + ": " + note);
  if (!c.grid.metric)
    say(
        fmt::format("{} has no length scale (--scale, in mm per pixel, gives it): both sectors are "
                    "assumed to have equal depth",
                    c.real.metres_per_pixel ? c.synthetic.label : c.real.label));
  for (const echo::BeatLength* beat : {&c.synthetic_beat, &c.real_beat})
    if (beat->frames == 0)
      say(fmt::format("{}: no beat found in the loop; frames are paired by the best shift and pace",
                      beat == &c.real_beat ? c.real.label : c.synthetic.label));
  if (c.time.confidence < kDoubtfulConfidence)
    say(
        fmt::format("the temporal alignment is ambiguous (confidence {:.2f}): give the frames of "
                    "end-diastole and end-systole, or R waves",
                    c.time.confidence));
  if (c.scene_fit && c.scene_fit->tilt && c.scene_fit->tilt->at_limit)
    say(
        fmt::format("the best tilt is at the limit of {:g} degrees: a better one may lie "
                    "beyond (--tilt)",
                    c.scene_fit->tilt->most_deg));
  if (c.space.used && c.space.at_limit)
    say("the best placement is at the limit of the search: a better one may lie beyond");
}

// A message names its file; notes are for pages and JSON, which do not.
std::string withoutName(std::string text, const echo::EchoLoop& loop) {
  for (const std::string& name : {loop.video.name, shownName(loop.video.name)})
    if (!name.empty() && text.starts_with(name + ":")) text.replace(0, name.size(), loop.label);
  return text;
}

// Metrics of frames do not need it.
void holdScene(const Scene& scene, const CompareOptions& options, const Monitor& monitor,
               Comparison& c) {
  try {
    c.scene_fit = std::make_shared<const fit::SceneFit>(
        fit::fitScene(scene, c.real, options.real_side, options.tilt_deg, monitor));
  } catch (const SceneError& error) {
    c.notes.push_back(
        fmt::format("the scene fit is not shown: {}", withoutName(error.what(), c.real)));
  }
}

// Phase of the beat between frames: of a render by its manifest, so that beats of different lengths
// keep theirs; otherwise by the length of the beat.
double phaseAt(double place, const Comparison& c) {
  const std::vector<double>& phases = c.synthetic.phases;
  double phase = place / c.synthetic_beat.frames;
  if (phases.size() == 1) phase += phases.front();
  if (phases.size() > 1) {
    const std::size_t i = std::min(static_cast<std::size_t>(place), phases.size() - 2);
    const double step = phases[i + 1] - phases[i];
    phase = phases[i] + (place - static_cast<double>(i)) * (step - std::floor(step));
  }
  return phase - std::floor(phase);
}

}  // namespace

Comparison compareLoops(const CompareOptions& options, const Monitor& monitor) {
  fit::checkTilt(options.tilt_deg);
  if (options.tilt_deg > 0 && options.scene.empty())
    throw SceneError(
        "--tilt: needs --scene, the scene that the synthetic loop was rendered from: another plane "
        "is cut from its meshes");
  if (!options.scene.empty()) readScene(options.scene);  // refused before the loops are read
  Steps steps(monitor);
  Comparison c;
  c.synthetic = echo::readLoop(options.synthetic, options.synthetic_side, false);
  steps.next();
  c.real = echo::readLoop(options.real, options.real_side, true);
  steps.next();
  std::optional<BoundaryBands> bands;
  registerLoops(options, c);
  steps.next();
  if (!options.scene.empty()) {
    bands.emplace(options.scene, c.synthetic, c.grid, 1e-3 * options.band_mm);
    holdScene(bands->scene(), options, monitor, c);
  }
  noteAssumptions(c);
  for (const std::string& note : c.notes) monitor.warn(note);
  const std::vector<double> discrepancy = discrepancies(c);
  c.discrepancy = meanCounted(c, discrepancy);
  std::vector<std::vector<float>> paired;
  for (std::size_t j = 0; j < c.real_beams.frames.size(); ++j) {
    FrameResult f;
    f.discrepancy = discrepancy[j];
    f.real_frame = static_cast<int>(j);
    f.real_time_s = c.real.video.rate.hz > 0 ? static_cast<double>(j) / c.real.video.rate.hz : 0;
    f.synthetic_place = c.time.place[j];
    if (f.synthetic_place >= 0 && c.synthetic_beat.frames > 0)
      f.synthetic_phase = phaseAt(f.synthetic_place, c);
    f.repeat = c.real.video.isRepeat(f.real_frame);
    c.frames.push_back(f);
    paired.push_back(pairedFrame(c, j));
  }
  c.curve = fitCurve(options, paired, c.real_beams.frames, c);
  steps.next();
  measureFrames(paired, bands ? &*bands : nullptr, c);
  steps.next();
  summarise(c);
  return c;
}

}  // namespace echocine::compare
