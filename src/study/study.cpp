#include "study/study.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/error.h"
#include "core/file.h"
#include "core/parallel.h"
#include "core/shown_path.h"
#include "core/stop.h"
#include "core/units.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/surfaces/probe_placement.h"
#include "render/render_pass.h"
#include "study/thumbnail.h"

namespace echocine {

namespace {

using Clock = std::chrono::steady_clock;

// More rays in a frame than the scene asks for are tried up to here. Our choice: some seconds.
constexpr double kMostRays = 4096;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Study {
 public:
  using RoundDone = std::function<void(const StudyResult&)>;
  Study(const Scene& scene, const StudyOptions& options, const Monitor& monitor,
        const RoundDone& round_done)
      : scene_(showing(scene)),
        options_(options),
        monitor_(monitor),
        round_done_(round_done),
        start_(Clock::now()) {}

  StudyResult run() {
    try {
      prepare();
    } catch (const Stopped&) {
      return finished();  // no row is timed yet
    }
    for (int round = 0; round < options_.repeats; ++round) {
      const Clock::time_point begin = Clock::now();
      const bool whole = visitAll(round);
      if (whole) result_.rounds = round + 1;
      const bool spent = !whole && budgetSpent();
      const double took_s = secondsSince(begin);
      const bool enough = spent || secondsSince(start_) + took_s > options_.budget_s;
      result_.complete = whole ? enough || round + 1 == options_.repeats : spent;
      if (!whole && !spent) break;  // stopped
      round_done_(finished());
      if (enough) break;
    }
    return finished();
  }

 private:
  bool budgetSpent() const { return secondsSince(start_) >= options_.budget_s; }
  // Half of the budget is left to measure in; our choice.
  bool preparedLongEnough() const { return secondsSince(start_) >= 0.5 * options_.budget_s; }
  void prepare();
  void addRow(const std::string& sweep, const std::string& knob, const std::string& value,
              Scene scene, const std::string& keys);
  void addSweep(const Knob& knob, std::size_t k, Preset around);
  bool visitAll(int round);
  void visit(std::size_t point, int round);
  void compare(std::size_t point);
  void tell();
  StudyResult finished() const;

  Scene scene_;
  const StudyOptions& options_;
  const Monitor& monitor_;
  const RoundDone& round_done_;
  Clock::time_point start_;
  MotionShelf shelf_;
  StudyResult result_;
  std::vector<SettingRun> probes_;  // of each point
  std::vector<std::string> signatures_;
  std::vector<FramePicture> reference_;
  std::vector<double> visit_s_;  // of each point, its last visit
  std::size_t visits_ = 0, unprepared_ = 0;
};

void Study::addRow(const std::string& sweep, const std::string& knob, const std::string& value,
                   Scene scene, const std::string& keys) {
  // Settings that a short budget leaves no time to prepare are left out, but for the reference.
  if (!result_.points.empty() && preparedLongEnough()) {
    ++unprepared_;
    return;
  }
  // A row that would take minutes a frame is named and left out, so that a study ends.
  const double rays = static_cast<double>(scene.accuracy.rays_per_beam) * scene.probe.lines;
  if (scene.accuracy.rays_per_beam > scene_.accuracy.rays_per_beam && rays > kMostRays) {
    result_.refused.push_back({knob + " " + value + ", " + sweep,
                               fmt::format("{:g} rays a frame, accepted: {:g}", rays, kMostRays)});
    return;
  }
  if (!result_.points.empty()) scene.signal.reference_intensity = result_.reference_intensity;
  try {
    SettingRun probe(std::move(scene), shelf_);
    std::string signature = probe.signature();
    // Rows that come to the same thing are measured once.
    const auto found = std::find(signatures_.begin(), signatures_.end(), signature);
    const auto point = static_cast<std::size_t>(found - signatures_.begin());
    if (found == signatures_.end()) {
      if (result_.points.empty()) {  // the reference: its white is everybody's
        result_.reference_intensity = probe.referenceIntensity(result_.frames);
        Scene white = probe.scene();
        white.signal.reference_intensity = result_.reference_intensity;
        probe = SettingRun(std::move(white), shelf_);
        signature = probe.signature();
      }
      StudyPoint fresh;
      fresh.scene = probe.scene();
      fresh.keys = keys;
      fresh.tracer = probe.plan().tracerName();
      result_.points.push_back(std::move(fresh));
      signatures_.push_back(std::move(signature));
      probes_.push_back(std::move(probe));
    }
    result_.rows.push_back({sweep, knob, value, point});
  } catch (const SceneError& error) {
    if (result_.points.empty()) throw;  // without its reference there is no study
    result_.refused.push_back(
        {knob + " " + value, withoutFolders(error.what(), scene_.file.parent_path())});
  }
}

void Study::addSweep(const Knob& knob, std::size_t k, Preset around) {
  const bool draft = around == Preset::draft;
  Setting setting = presetSetting(result_.table, around);
  for (std::size_t v = 0; v < knob.values.size(); ++v) {
    setting[k] = v;
    addRow(draft ? "from draft" : "from reference", knob.name, knob.values[v].label,
           sceneWith(scene_, result_.table, setting), settingText(result_.table, setting));
  }
}

void Study::prepare() {
  if (!options_.folder.empty()) {
    makeFolder(options_.folder);
    // A folder that takes no files is found out before anything is measured.
    const WholeFile writable(options_.folder / "study.json");
  }
  result_.scene_file = scene_.file.filename().string();
  result_.dynamic_range_db = scene_.signal.dynamic_range_db;
  result_.threads = threadCount();
  result_.frames = probeFrames(scene_, options_.frames);
  result_.scene_sha256 = sceneSha256(scene_, *shelf_.motionOf(scene_));
  result_.table = knobsOf(scene_);
  // The reference must be the first point: its white and its pictures are everybody's measure.
  for (const Preset preset : {Preset::reference, Preset::draft, Preset::standard, Preset::fine}) {
    const Setting setting = presetSetting(result_.table, preset);
    addRow("preset", "preset", kPresetNames[static_cast<std::size_t>(preset)],
           sceneWith(scene_, result_.table, setting), settingText(result_.table, setting));
  }
  addRow("preset", "preset", "scene", scene_, "as written");
  for (const Preset around : {Preset::draft, Preset::reference})
    for (std::size_t k = 0; k < result_.table.knobs.size(); ++k) {
      const Knob& knob = result_.table.knobs[k];
      const auto& only = options_.knobs;
      if (only.empty() || std::find(only.begin(), only.end(), knob.name) != only.end())
        addSweep(knob, k, around);
    }
  if (unprepared_ > 0)
    result_.refused.push_back(
        {fmt::format("{} more rows", unprepared_),
         fmt::format("--budget-s {:g} leaves no time to prepare them", options_.budget_s)});
  visit_s_.resize(result_.points.size());
  for (const FrameTime& frame : result_.frames)
    reference_.push_back(probes_[0].picture(frame, result_.reference_intensity, true));
}

void Study::tell() {
  // Each setting still to be visited is assumed to take the mean time of the visited ones.
  double known = 0;
  std::size_t count = 0;
  for (const double s : visit_s_)
    if (s > 0) {
      known += s;
      ++count;
    }
  const std::size_t total = result_.points.size() * static_cast<std::size_t>(options_.repeats);
  const double mean = count > 0 ? known / static_cast<double>(count) : 0;
  monitor_.tell({Task::settings, visits_, total, mean * static_cast<double>(total - visits_)});
}

// Forwards and backwards in turn: a processor that warms up and slows down cancels in the medians.
bool Study::visitAll(int round) {
  const std::size_t count = result_.points.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!monitor_.keep_going() || (visits_ > 0 && budgetSpent())) return false;
    try {
      visit(round % 2 == 0 ? i : count - 1 - i, round);
    } catch (const Stopped&) {
      return false;
    }
  }
  return true;
}

void Study::visit(std::size_t point, int round) {
  const Clock::time_point begin = Clock::now();
  SettingRun& probe = probes_[point];
  StudyPoint& p = result_.points[point];
  if (round == 0)
    compare(point);
  else  // hierarchies are built and memory is touched before the clock runs
    probe.picture(result_.frames.front(), result_.reference_intensity, false);
  // Enough frames to keep all threads busy; with one thread each probe frame once.
  const std::size_t frames =
      std::max(result_.frames.size(), static_cast<std::size_t>(2 * (threadCount() - 1)));
  p.times.push_back(probe.timeBatch(result_.frames, frames, result_.reference_intensity));
  probe.rest();
  visit_s_[point] = secondsSince(begin);
  ++visits_;
  tell();
}

void Study::compare(std::size_t point) {
  SettingRun& probe = probes_[point];
  StudyPoint& p = result_.points[point];
  StudyErrors& e = p.errors;
  InterfaceError interfaces;
  double squares = 0, ssim = 0, bytes = 0, worst = -1;
  for (std::size_t f = 0; f < result_.frames.size(); ++f) {
    const FramePicture picture =
        probe.picture(result_.frames[f], result_.reference_intensity, true, MadeOf::stored);
    const FramePicture& truth = reference_[f];
    const PictureError error = pictureError(picture.grey, truth.grey, result_.dynamic_range_db);
    squares += error.rms_db * error.rms_db;
    e.worst_rms_db = std::max(e.worst_rms_db, error.rms_db);
    e.max_db = std::max(e.max_db, error.max_db);
    ssim += structuralSimilarity(picture.image, truth.image, truth.grey);
    interfaces.add(picture.interfaces, truth.interfaces);
    bytes += static_cast<double>(picture.exr_bytes);
    if (error.rms_db > worst) {
      worst = error.rms_db;
      p.thumbnail = thumbnail(picture.image);
      p.difference = differenceThumbnail(picture, truth, result_.dynamic_range_db);
    }
  }
  const auto frames = static_cast<double>(result_.frames.size());
  // Frames have equally many pixels in the sector, so the mean of their squares is that of all
  // pixels.
  e.rms_db = std::sqrt(squares / frames);
  e.ssim = ssim / frames;
  e.interface_rms_mm = millimetresFromMetres(interfaces.rms_m());
  e.interface_p95_mm = millimetresFromMetres(interfaces.percentile95_m());
  e.interface_missed = interfaces.missedShare();
  p.exr_bytes = bytes / frames;
  p.work = probe.workPerFrame();
}

StudyResult Study::finished() const {
  StudyResult result = result_;
  std::erase_if(result.rows,
                [&](const StudyRow& row) { return result.points[row.point].times.empty(); });
  return result;
}

}  // namespace

// In the middle of equal parts of the beat: neither all at rest nor all in motion.
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
                     const std::function<void(const StudyResult&)>& round_done) {
  StudyResult result;
  withThreads(options.threads,
              [&] { result = Study(placed(scene), options, monitor, round_done).run(); });
  return result;
}

}  // namespace echocine
