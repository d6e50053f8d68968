#include "cli/accuracy_options.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>

#include "cli/progress_line.h"
#include "cli/standard_error.h"
#include "core/error.h"
#include "scene/ranges.h"
#include "study/tolerance.h"

namespace echocine {

namespace {

// The message names all, in the order from rough to fine.
Preset presetOf(const std::string& name) {
  const auto found = std::find(kPresetNames.begin(), kPresetNames.end(), name);
  if (found == kPresetNames.end())
    throw SceneError(fmt::format("--preset: \"{}\" is not a preset, accepted: {}", name,
                                 fmt::join(kPresetNames, ", ")));
  return static_cast<Preset>(found - kPresetNames.begin());
}

AccuracyChoice choose(const Scene& scene, double tolerance_db, int threads, bool quiet) {
  ProgressLine line(quiet);
  AccuracyChoice choice = chooseWithin(scene, tolerance_db, threads, line.monitor());
  line.finish();
  return choice;
}

}  // namespace

void AccuracyOptions::addTo(CLI::App& command) {
  command
      .add_option("--preset", preset_,
                  "Preset of all accuracy settings that `echocine study` varies")
      ->type_name(fmt::format("{{{}}}", fmt::join(kPresetNames, ",")));
  command
      .add_option("--tolerance-db", tolerance_db_,
                  "Choose the cheapest settings within this RMS error of the reference preset, dB "
                  "of the displayed range (also accuracy.tolerance_db)")
      ->type_name("DB");
}

// The command line goes before the scene's wish; two demands on the line, or a preset over a
// scene's tolerance, contradict each other and are refused.
AccuracyRecord AccuracyOptions::resolve(Scene& scene, int threads, bool quiet) const {
  const std::optional<double> wanted_db =
      tolerance_db_ ? tolerance_db_ : scene.accuracy.tolerance_db;
  if (tolerance_db_ && !ranges::kTolerance_db.contains(*tolerance_db_))
    throw SceneError(fmt::format("--tolerance-db: {} is not accepted: {}", *tolerance_db_,
                                 ranges::kTolerance_db.text()));
  if (preset_.empty() && !wanted_db) return {};
  AccuracyChoice choice;
  if (preset_.empty()) {
    choice = choose(scene, *wanted_db, threads, quiet);
  } else {
    const Preset preset = presetOf(preset_);
    if (tolerance_db_) throw SceneError("--preset: excludes --tolerance-db, accepted: one of them");
    if (wanted_db)
      throw SceneError(
          atPlace(scene.accuracy.tolerance_place, "excludes --preset, accepted: one of them"));
    choice = atPreset(scene, preset);
  }
  scene = std::move(choice.scene);
  if (!quiet)
    writeError(
        fmt::format("echocine: accuracy: {}: {}\n", choice.record.setting, choice.record.reason));
  return std::move(choice.record);
}

}  // namespace echocine
