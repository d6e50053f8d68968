#include "study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <span>

#include "core/error.h"
#include "core/file.h"
#include "core/output_check.h"
#include "core/parallel.h"
#include "core/shown_path.h"
#include "core/stop.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/surfaces/probe_placement.h"
#include "render/render_pass.h"
#include "study/study_errors.h"

namespace echocine {

namespace {

using Clock = std::chrono::steady_clock;

// More rays in a frame than the scene asks for are tried up to here. Our choice.
constexpr double kMostRays = 4096;

// A setting whose test frames take longer together is timed once. Our choice.
constexpr double kTimedOnce_ms = 1000;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// A row to be measured. No setting: the scene as written.
struct RowWanted {
  std::string sweep, knob, value;
  std::optional<Setting> setting;
};

// Does the stack keep every bit of the intensities?
bool storesAll(const OutputSettings& output) {
  return !output.exr ||
         (output.exr_pixel == ExrPixel::whole && output.exr_compression != ExrCompression::pxr24);
}

class Study {
 public:
  using RowDone = std::function<void(const StudyResult&)>;
  Study(const Scene& scene, const StudyOptions& options, const Monitor& monitor,
        const RowDone& row_done)
      : scene_(showing(scene)),
        options_(options),
        monitor_(monitor),
        row_done_(row_done),
        start_(Clock::now()) {}

  StudyResult run() {
    try {
      withThreads(0, [&] { prepare(); });
      if (firstRound()) laterRounds();
    } catch (const Stopped&) {  // what is finished is the result
    }
    return result_;
  }

 private:
  bool budgetSpent() const { return secondsSince(start_) >= options_.budget_s; }
  void prepare();
  bool firstRound();
  void laterRounds();
  void measure(const RowWanted& row);
  void refuse(const RowWanted& row, const std::string& reason);
  void takeReference(SettingRun& probe);
  void compare(SettingRun& probe, StudyPoint& point);
  StageTimes timeOf(SettingRun& probe);
  void visited(Clock::time_point since, std::size_t left);

  Scene scene_;
  const StudyOptions& options_;
  const Monitor& monitor_;
  const RowDone& row_done_;
  Clock::time_point start_;
  MotionShelf shelf_;
  StudyResult result_;
  std::vector<RowWanted> wanted_;
  std::vector<SettingRun> probes_;  // of each point
  std::vector<std::string> signatures_;
  std::vector<FramePicture> reference_;
  std::size_t visits_ = 0;
  double visits_s_ = 0;
};

void Study::prepare() {
  if (!options_.folder.empty()) {
    makeFolder(options_.folder);
    checkOutputFile(options_.folder / "study.json");
  }
  result_.scene_file = scene_.file.filename().string();
  result_.dynamic_range_db = scene_.signal.dynamic_range_db;
  result_.frames = probeFrames(scene_, options_.frames);
  result_.scene_sha256 = sceneSha256(scene_, *shelf_.motionOf(scene_));
  result_.table = knobsOf(scene_);
  for (const Preset preset : {Preset::reference, Preset::draft, Preset::standard, Preset::fine})
    wanted_.push_back({"preset", "preset", kPresetNames[static_cast<std::size_t>(preset)],
                       presetSetting(result_.table, preset)});
  wanted_.push_back({"preset", "preset", "scene", std::nullopt});
  for (const Preset around : {Preset::draft, Preset::reference})
    for (std::size_t k = 0; k < result_.table.knobs.size(); ++k) {
      const Knob& knob = result_.table.knobs[k];
      const auto& only = options_.knobs;
      if (!only.empty() && std::find(only.begin(), only.end(), knob.name) == only.end()) continue;
      Setting setting = presetSetting(result_.table, around);
      for (setting[k] = 0; setting[k] < knob.values.size(); ++setting[k])
        wanted_.push_back({around == Preset::draft ? "from draft" : "from reference", knob.name,
                           knob.values[setting[k]].label, setting});
    }
}

// False when it was stopped or the budget is spent.
bool Study::firstRound() {
  for (std::size_t i = 0; i < wanted_.size(); ++i) {
    if (!monitor_.keep_going()) return false;
    if (i > 0 && budgetSpent()) {
      result_.complete = true;
      result_.refused.push_back(
          {"", fmt::format("{} more rows", wanted_.size() - i), "",
           fmt::format("--budget-s {:g} leaves no time for them", options_.budget_s)});
      return false;
    }
    const Clock::time_point begin = Clock::now();
    try {
      measure(wanted_[i]);
    } catch (const Stopped&) {
      throw;
    } catch (const SceneError& error) {
      if (result_.points.empty()) throw;  // without its reference there is no study
      refuse(wanted_[i], error.what());
    } catch (const JobError& error) {
      if (result_.points.empty()) throw;
      refuse(wanted_[i], error.what());
    }
    if (i + 1 == wanted_.size()) result_.rounds = 1;
    result_.complete = i + 1 == wanted_.size() && options_.repeats == 1;
    row_done_(result_);
    visited(begin, wanted_.size() - i - 1 +
                       result_.points.size() * static_cast<std::size_t>(options_.repeats - 1));
  }
  return true;
}

void Study::refuse(const RowWanted& row, const std::string& reason) {
  result_.refused.push_back(
      {row.sweep, row.knob, row.value, withoutFolders(reason, scene_.file.parent_path())});
}

void Study::measure(const RowWanted& row) {
  Scene scene = row.setting ? sceneWith(scene_, result_.table, *row.setting) : scene_;
  // A row that would take minutes a frame is named and left out, so that a study ends.
  const double rays = static_cast<double>(scene.accuracy.rays_per_beam) * scene.probe.lines;
  if (scene.accuracy.rays_per_beam > scene_.accuracy.rays_per_beam && rays > kMostRays)
    return refuse(row, fmt::format("{:g} rays a frame, accepted: {:g}", rays, kMostRays));
  if (!result_.points.empty()) scene.signal.reference_intensity = result_.reference_intensity;
  std::optional<SettingRun> probe;
  StudyPoint point;
  std::string signature;
  std::size_t same = 0;  // rows that come to the same thing are measured once
  withThreads(0, [&] {
    probe.emplace(std::move(scene), shelf_);
    signature = probe->signature();
    same = static_cast<std::size_t>(std::find(signatures_.begin(), signatures_.end(), signature) -
                                    signatures_.begin());
    if (same < signatures_.size()) return;
    if (reference_.empty()) {
      takeReference(*probe);
      signature = probe->signature();
    }
    compare(*probe, point);
    probe->prepareTiming();
  });
  if (same == signatures_.size()) {
    point.times.push_back(timeOf(*probe));
    probe->rest();
    point.exr_bytes = point.times.front().exr_bytes;
    point.scene = probe->scene();
    point.keys = row.setting ? settingText(result_.table, *row.setting) : "as written";
    point.tracer = probe->plan().tracerName();
    result_.points.push_back(std::move(point));
    signatures_.push_back(std::move(signature));
    probes_.push_back(std::move(*probe));
  }
  result_.rows.push_back({row.sweep, row.knob, row.value, same});
}

// Its white and its pictures are everybody's. Precondition: inside withThreads().
void Study::takeReference(SettingRun& probe) {
  result_.reference_intensity = probe.referenceIntensity(result_.frames);
  if (!probe.scene().signal.reference_intensity) {
    Scene white = probe.scene();
    white.signal.reference_intensity = result_.reference_intensity;
    probe = SettingRun(std::move(white), shelf_);
  }
  reference_ = probe.pictures(result_.frames, result_.reference_intensity, true);
}

void Study::compare(SettingRun& probe, StudyPoint& point) {
  // The reference's own pictures are known, unless its files lose some of them.
  const bool known = result_.points.empty() && storesAll(probe.scene().output);
  std::vector<FramePicture> made;
  if (!known)
    made = probe.pictures(result_.frames, result_.reference_intensity, true, MadeOf::stored);
  compareWith(reference_, known ? reference_ : made, result_.dynamic_range_db, point);
  point.work = probe.workPerFrame();
}

StageTimes Study::timeOf(SettingRun& probe) {
  StageTimes times;
  withThreads(options_.threads, [&] {
    result_.threads = threadCount();
    // Working memory is touched before the clock runs.
    probe.timeBatch(std::span(result_.frames).first(1), 1, result_.reference_intensity);
    // Enough frames to keep all threads busy; with one thread each probe frame once.
    const std::size_t frames =
        std::max(result_.frames.size(), static_cast<std::size_t>(2 * (threadCount() - 1)));
    times = probe.timeBatch(result_.frames, frames, result_.reference_intensity);
  });
  return times;
}

void Study::laterRounds() {
  std::vector<std::size_t> again;
  for (std::size_t p = 0; p < result_.points.size(); ++p)
    if (result_.points[p].times.front().wall_ms * static_cast<double>(result_.frames.size()) <
        kTimedOnce_ms)
      again.push_back(p);
  for (int round = 1; round < options_.repeats; ++round) {
    const Clock::time_point begin = Clock::now();
    std::reverse(again.begin(), again.end());
    for (std::size_t i = 0; i < again.size(); ++i) {
      if (!monitor_.keep_going()) return;
      if (budgetSpent()) {
        result_.complete = true;
        return;
      }
      const Clock::time_point visit = Clock::now();
      SettingRun& probe = probes_[again[i]];
      withThreads(0, [&] { probe.prepareTiming(); });
      result_.points[again[i]].times.push_back(timeOf(probe));
      probe.rest();
      visited(visit, again.size() * static_cast<std::size_t>(options_.repeats - round) - i - 1);
    }
    result_.rounds = round + 1;
    const bool enough = secondsSince(start_) + secondsSince(begin) > options_.budget_s;
    result_.complete = enough || result_.rounds == options_.repeats;
    row_done_(result_);
    if (enough) return;
  }
}

// Visits still to come are taken to last as long as the mean of those before.
void Study::visited(Clock::time_point since, std::size_t left) {
  visits_s_ += secondsSince(since);
  ++visits_;
  monitor_.tell({Task::settings, visits_, visits_ + left,
                 visits_s_ / static_cast<double>(visits_) * static_cast<double>(left)});
}

}  // namespace

// In the middle of equal parts of the beat.
std::vector<FrameTime> probeFrames(const Scene& scene, int count) {
  const CardiacClock clock(scene);
  int of_beat = 0;
  while (of_beat < clock.frameCount() && clock.at(of_beat).beat == 0) ++of_beat;
  const int wanted = std::min(count, of_beat);
  std::vector<FrameTime> frames;
  for (int i = 0; i < wanted; ++i) frames.push_back(clock.at((2 * i + 1) * of_beat / (2 * wanted)));
  return frames;
}

StudyResult runStudy(const Scene& scene, const StudyOptions& options, const Monitor& monitor,
                     const std::function<void(const StudyResult&)>& row_done) {
  Scene standing;
  withThreads(0, [&] { standing = placed(scene); });
  return Study(standing, options, monitor, row_done).run();
}

}  // namespace echocine
