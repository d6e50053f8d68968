#pragma once
// Cost and error of each knob of a scene, measured on this machine.

#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "core/monitor.h"
#include "metrics/picture_error.h"
#include "metrics/statistics.h"
#include "motion/cycle/cardiac_clock.h"
#include "output/manifest.h"
#include "study/knobs.h"
#include "study/setting_run.h"

namespace echocine {

struct StudyOptions {
  std::filesystem::path folder;
  int threads = 1;                 // frames in parallel during timing; 0: one per core. Pictures
                                   // are compared on all cores
  int frames = 4;                  // compared and timed, evenly spaced over the first beat
  int repeats = 3;                 // rounds over all settings
  std::vector<std::string> knobs;  // only these; empty: all
  double budget_s =
      std::numeric_limits<double>::infinity();  // a round that would end later is not started
};

// RMS errors that differ by less count as equal in rankings: storing intensities changes them by as
// much. Our choice.
inline constexpr double kToldApart_db = 0.005;

// Errors of the mean over seeds (as meanOverSeeds() of setting_run.h plans it) against the
// reference's, over the test frames: no two settings need the same speckle or noise for it.
struct StudyErrors {
  double rms_db = 0;        // over the pixels of all frames
  double worst_rms_db = 0;  // of the worst frame
  double max_db = 0;        // of a single pixel
  double ssim = 1;          // mean over the frames
  double interface_rms_mm = 0, interface_p95_mm = 0, interface_missed = 0;
};

// Measurements of one setting; rows with equal settings share it.
struct StudyPoint {
  Scene scene;
  std::string keys;  // "probe.lines = 64, ...", or "as written"
  std::string tracer;
  StudyErrors errors;
  WorkCounts work;                // per frame
  double exr_bytes = 0;           // of the intensity stack, per frame; 0 without one
  std::vector<StageTimes> times;  // one for each round
  std::vector<std::byte> thumbnail,
      difference;  // JPEG; brighter is a larger difference from the reference

  Quartiles wall_ms() const;
  double stage_ms(Stage stage) const;  // median over the rounds
};

// A line of the study that could not be rendered.
struct RefusedRow {
  std::string sweep, knob, value, reason;
};

// One line of the study.
struct StudyRow {
  std::string sweep;        // "preset", "from draft", "from reference"
  std::string knob, value;  // for a preset: "preset" and its name, or "scene"
  std::size_t point = 0;    // index into StudyResult::points
};

struct StudyResult {
  std::string scene_file, scene_sha256;
  std::vector<FrameTime> frames;
  double reference_intensity = 1, dynamic_range_db = 60;
  KnobTable table;
  std::vector<StudyPoint> points;  // the reference first
  std::vector<StudyRow> rows;
  std::vector<RefusedRow> refused;
  int rounds = 0, threads = 1;
  bool complete = false;
};

// The test frames: `count` frames of the first beat, evenly spaced, or all if there are fewer.
std::vector<FrameTime> probeFrames(const Scene& scene, int count);

// Runs the study. The first round compares and times each setting and hands over the results after
// each row. Later rounds time the settings again, alternately backwards and forwards, so that a
// drift of the clock cancels in the medians; those whose frames took over a second together are
// timed once. A setting that cannot be rendered becomes a refused row; without the reference there
// is no study. `row_done` receives the rows so far, after each row and each later round. Throws
// SceneError and JobError.
StudyResult runStudy(
    const Scene& scene, const StudyOptions& options, const Monitor& monitor,
    const std::function<void(const StudyResult&)>& row_done = [](const StudyResult&) {});

// One step of a knob in a sweep, in time and error.
struct KnobStep {
  std::string knob, from, to;
  double added_ms = 0, error_drop_db = 0;
  bool worth() const { return error_drop_db > kToldApart_db; }
  // dB per ms; a step without measurable time counts as a hundredth of a millisecond.
  double perMillisecond() const;
};

// For each knob, the largest reduction of the error per millisecond when it alone is raised from
// draft, best first.
std::vector<KnobStep> bestBuys(const StudyResult& result);

}  // namespace echocine
