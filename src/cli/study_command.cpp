#include "cli/study_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "cli/documents.h"
#include "cli/number_check.h"
#include "cli/progress_line.h"
#include "core/error.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/scene_reader.h"
#include "study/study_files.h"
#include "study/study_folder.h"

namespace echocine {

namespace {

// Here and not in the parser, so that the message names the knobs in the same form as a scene's
// errors.
void refuseUnknownKnobs(const std::vector<std::string>& wanted) {
  const std::vector<std::string> names = knobNames();
  for (const std::string& knob : wanted)
    if (std::find(names.begin(), names.end(), knob) == names.end())
      throw SceneError(
          fmt::format("--knobs: \"{}\" is not a knob, accepted: {}", knob, fmt::join(names, ", ")));
}

}  // namespace

StudyCommand::StudyCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "study",
      "Measure computing time (ms) and image error (dB, mm) of each accuracy setting of a scene");
  command->add_option("scene", scene_file_, "Scene file (TOML; each key carries its unit)")
      ->required();
  command
      ->add_option("-o,--output", options_.folder,
                   "Folder for study.html, study.csv and study.json")
      ->required();
  command
      ->add_option("--frames", options_.frames,
                   "Frames to compare and time, evenly spaced over the first beat")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--repeats", options_.repeats,
                   "Number of time measurements of each setting; the median is reported")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command
      ->add_option("--knobs", options_.knobs,
                   fmt::format("Only these knobs, a,b,...: {}", fmt::join(knobNames(), ", ")))
      ->delimiter(',');
  command
      ->add_option("--budget-s", options_.budget_s,
                   "Start no further measurement after this many seconds")
      ->check(within(1e-3, 1e9))
      ->type_name("SECONDS");
  command
      ->add_option("--threads", options_.threads,
                   "Frames rendered in parallel during timing; 0: one per core")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  command->add_flag("--quiet", quiet_, "Print errors only");
  command->footer(
      "Example: echocine study scene.toml -o study --knobs lines,samples --budget-s 60\n" +
      std::string(kDocuments));
}

int StudyCommand::run() {
  refuseUnknownKnobs(options_.knobs);
  const Scene scene = placed(readScene(scene_file_));
  ProgressLine line(quiet_);
  StudyFolder files(options_.folder);
  const StudyResult result = runStudy(scene, options_, line.monitor(),
                                      [&](const StudyResult& r) { files.write(r, false); });
  line.finish();
  if (result.rows.empty())
    throw JobError("stopped before the first setting was measured: nothing is written");
  files.write(result, true);
  if (!quiet_) fmt::print("{}", studyTable(result));
  if (!result.complete)
    throw JobError(fmt::format("stopped: {} rows are finished in {}", result.rows.size(),
                               options_.folder.string()));
  if (!quiet_) fmt::print("{}: study.html, study.csv, study.json\n", options_.folder.string());
  return 0;
}

}  // namespace echocine
