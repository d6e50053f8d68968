#include "cli/archive_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "archive/echoxflow.h"
#include "archive/zea_file.h"
#include "cli/documents.h"
#include "cli/progress_line.h"
#include "core/error.h"
#include "scene/scene_reader.h"
#include "scene/view_names.h"

namespace echocine {

namespace {

constexpr std::size_t kExamDigits = 12;  // of the scene's hash; our choice

}  // namespace

ArchiveCommand::ArchiveCommand(CLI::App& app) {
  CLI::App* command = app.add_subcommand(
      "archive", "Write a loop in beam space, with velocities, ECG and contours, for research");
  command->add_option("scene", scene_file_, "Scene file (TOML; each key carries its unit)")
      ->required();
  command
      ->add_option("-o,--output", output_,
                   "echoxflow: folder of the archive, which may have other recordings; zea: file")
      ->required();
  command->add_option("--layout", layout_, "Layout of the archive")
      ->check(CLI::IsMember(std::vector<std::string>{"echoxflow", "zea"}))
      ->required();
  command->add_option("--exam", exam_,
                      "Name of the examination or subject; default: from the scene's hash");
  command->add_option("--recording", recording_,
                      "With echoxflow: name of the recording; default: the view, or loop");
  command->add_option("--threads", threads_, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", quiet_, "Print errors only");
  command->footer("Example: echocine archive scene.toml -o archive --layout echoxflow\n" +
                  std::string(kDocuments));
}

int ArchiveCommand::run() {
  const Scene scene = readScene(scene_file_);
  if (layout_ == "echoxflow") checkEchoXFlow(scene, output_, exam_, recording_);
  if (layout_ == "zea") {
    if (!recording_.empty())
      throw SceneError("--recording: is accepted with --layout echoxflow only");
    checkZea(output_, exam_);
  }
  ProgressLine progress(quiet_);
  const BeamLoop loop = makeBeamLoop(scene, threads_, progress.monitor());
  progress.finish();
  const std::string exam = exam_.empty() ? loop.scene_sha256.substr(0, kExamDigits) : exam_;
  std::string recording = recording_;
  if (recording.empty()) recording = loop.view ? std::string(keyOf(*loop.view)) : "loop";
  if (layout_ == "zea")
    writeZea(loop, output_, exam);
  else
    writeEchoXFlow(loop, output_, exam, recording);
  if (quiet_) return 0;
  fmt::print("{}: {} frames of {} lines and {} samples, exam {}{}\n", output_.string(), loop.frames,
             loop.lines, loop.samples, exam, layout_ == "zea" ? "" : ", recording " + recording);
  return 0;
}

}  // namespace echocine
