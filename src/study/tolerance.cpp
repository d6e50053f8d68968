#include "study/tolerance.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <optional>

#include "core/error.h"
#include "core/parallel.h"
#include "metrics/picture_error.h"
#include "study/cost_model.h"
#include "study/setting_run.h"
#include "study/study.h"

namespace echocine {

namespace {

// Error of the worst probe frame, and cost by the model.
struct Tried {
  double error_db = 0, cost_ms = 0;
};

class Descent {
 public:
  Descent(const Scene& scene, double tolerance_db, const Monitor& monitor)
      : scene_(showing(scene)),
        limit_db_(tolerance_db / kToleranceSafety),
        monitor_(monitor),
        table_(knobsOf(scene_)),
        frames_(probeFrames(scene_, kToleranceFrames)),
        setting_(presetSetting(table_, Preset::reference)),
        steps_(table_.knobs.size()) {
    for (const FrameTime& frame : frames_) record_.probe_phases.push_back(frame.phase);
    record_.tolerance_db = tolerance_db;
    record_.safety = kToleranceSafety;
    for (std::size_t k = 0; k < steps_.size(); ++k)
      steps_[k].rung = table_.knobs[k].ladder.size() - 1;
  }

  AccuracyChoice run(const Scene& written);

 private:
  struct Step {
    std::size_t rung = 0;                                    // of the knob's ladder
    bool closed = false;                                     // the next rung down errs too much
    double worth = std::numeric_limits<double>::infinity();  // ms saved per dB^2; not tried yet
  };

  void makeReference();
  Tried tryOut(const Setting& setting, bool reference);
  void stepDown(std::size_t knob);
  std::optional<std::size_t> nextKnob() const;

  Scene scene_;
  double limit_db_;
  const Monitor& monitor_;
  KnobTable table_;
  std::vector<FrameTime> frames_;
  Setting setting_;
  std::vector<Step> steps_;
  MotionShelf shelf_;
  std::vector<FramePicture> reference_;
  Tried here_;  // the setting so far
  std::map<Setting, Tried> tried_;
  AccuracyRecord record_;
};

Tried Descent::tryOut(const Setting& setting, bool reference) {
  if (const auto known = tried_.find(setting); known != tried_.end()) return known->second;
  if (!monitor_.keep_going()) throw JobError("stopped while the accuracy was chosen");
  SettingRun probe(sceneWith(scene_, table_, setting), shelf_);
  if (reference) {
    scene_.signal.reference_intensity = probe.referenceIntensity(frames_);
    probe = SettingRun(sceneWith(scene_, table_, setting), shelf_);
  }
  const auto start = std::chrono::steady_clock::now();
  Tried tried;
  std::vector<FramePicture> pictures =
      probe.pictures(frames_, *scene_.signal.reference_intensity, false);
  if (reference) reference_ = pictures;
  for (std::size_t f = 0; f < frames_.size(); ++f)
    tried.error_db = std::max(
        tried.error_db,
        pictureError(pictures[f].grey, reference_[f].grey, scene_.signal.dynamic_range_db).rms_db);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  tried.cost_ms =
      modelledCost_ms(probe.scene(), probe.plan(), probe.workPerFrame(), probe.vertices());
  record_.candidates.push_back({settingText(table_, setting), tried.error_db, tried.cost_ms,
                                took.count() / static_cast<double>(frames_.size()),
                                tried.error_db <= limit_db_});
  monitor_.tell({Task::accuracy, record_.candidates.size(), 0});
  return tried_[setting] = tried;
}

void Descent::stepDown(std::size_t knob) {
  Step& step = steps_[knob];
  Setting lower = setting_;
  lower[knob] = table_.knobs[knob].ladder[step.rung - 1];
  Tried tried;
  try {
    tried = tryOut(lower, false);
  } catch (const SceneError&) {  // the meshes refuse this rung
    step.closed = true;
    return;
  }
  const double saved_ms = here_.cost_ms - tried.cost_ms;
  // Errors nearly always grow on the way down, so a rung that fails now would fail later too.
  if (tried.error_db > limit_db_ || saved_ms <= 0) {
    step.closed = true;
    return;
  }
  // A step without error is worth taking, but not infinitely: its cost still counts.
  constexpr double kLeast_db2 = 1e-6;
  const double added_db2 = tried.error_db * tried.error_db - here_.error_db * here_.error_db;
  const double worth = saved_ms / std::max(added_db2, kLeast_db2);
  // Taken at once unless another knob's next step promises more for the same error.
  const bool best = std::none_of(steps_.begin(), steps_.end(), [&](const Step& other) {
    return &other != &step && !other.closed && other.rung > 0 && other.worth > worth;
  });
  step.worth = worth;
  if (!best) return;
  setting_ = lower;
  here_ = tried;
  --step.rung;
}

// Knobs never tried are worth infinity, so each is tried once before any is tried again.
std::optional<std::size_t> Descent::nextKnob() const {
  std::optional<std::size_t> next;
  for (std::size_t k = 0; k < steps_.size(); ++k)
    if (!steps_[k].closed && steps_[k].rung > 0 && (!next || steps_[k].worth > steps_[*next].worth))
      next = k;
  return next;
}

AccuracyChoice Descent::run(const Scene& written) {
  here_ = tryOut(setting_, true);
  const double reference_ms = here_.cost_ms;
  while (const std::optional<std::size_t> knob = nextKnob()) stepDown(*knob);
  // A setting that was passed over for a step that promised more may have stayed the cheapest.
  for (const auto& [setting, tried] : tried_)
    if (tried.error_db <= limit_db_ && tried.cost_ms < here_.cost_ms) {
      setting_ = setting;
      here_ = tried;
    }
  record_.setting = settingText(table_, setting_);
  record_.reason = fmt::format(
      "error of {:.3g} dB RMS in the worst of {} test frames, accepted: {:.3g} ({:g} with a margin "
      "of {:g}); {} settings tried; {:.3g} times cheaper than the reference by counted work",
      here_.error_db, frames_.size(), limit_db_, *record_.tolerance_db, kToleranceSafety,
      record_.candidates.size(), reference_ms / here_.cost_ms);
  return {sceneWith(written, table_, setting_), std::move(record_)};
}

}  // namespace

AccuracyChoice chooseWithin(const Scene& scene, double tolerance_db, int threads,
                            const Monitor& monitor) {
  AccuracyChoice choice;
  withThreads(threads, [&] { choice = Descent(scene, tolerance_db, monitor).run(scene); });
  choice.scene.accuracy.tolerance_db.reset();
  return choice;
}

AccuracyChoice atOwnTolerance(const Scene& scene, int threads, const Monitor& monitor) {
  if (!scene.accuracy.tolerance_db) return {scene, {}};
  return chooseWithin(scene, *scene.accuracy.tolerance_db, threads, monitor);
}

AccuracyChoice atPreset(const Scene& scene, Preset preset) {
  const KnobTable table = knobsOf(scene);
  const Setting setting = presetSetting(table, preset);
  AccuracyChoice choice{sceneWith(scene, table, setting), {}};
  choice.record.preset = kPresetNames[static_cast<std::size_t>(preset)];
  choice.record.setting = settingText(table, setting);
  choice.record.reason = "the requested preset";
  return choice;
}

}  // namespace echocine
