#include "cli/render_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <charconv>

#include "cli/documents.h"
#include "cli/progress_line.h"
#include "core/error.h"
#include "core/output_check.h"
#include "core/stop.h"
#include "frame/plan_loop.h"
#include "motion/cycle/cardiac_clock.h"
#include "motion/surfaces/probe_placement.h"
#include "output/volumes_csv.h"
#include "scene/scene_reader.h"
#include "scene/truth_reader.h"

namespace echocine {

namespace {

// "A:B", either end left out for the loop's own: ":10", "10:", "3:4".
std::pair<int, int> parseRange(const std::string& text, int loop_frames) {
  const std::size_t colon = text.find(':');
  std::pair<int, int> range{0, loop_frames};
  const auto read = [&](std::string_view part, int& value) {
    if (part.empty()) return true;
    const auto result = std::from_chars(part.data(), part.data() + part.size(), value);
    return result.ec == std::errc() && result.ptr == part.data() + part.size();
  };
  const std::string_view view(text);
  if (colon == std::string::npos || !read(view.substr(0, colon), range.first) ||
      !read(view.substr(colon + 1), range.second))
    throw SceneError(fmt::format(
        "--frames: \"{}\" is not a range, accepted: A:B for the frames A to B - 1", text));
  return range;
}

void askForTruth(const std::string& list, Scene& scene) {
  std::vector<std::string> kinds;
  for (std::size_t begin = 0, end = 0; begin < list.size(); begin = end + 1) {
    end = std::min(list.find(',', begin), list.size());
    kinds.push_back(list.substr(begin, end - begin));
  }
  const std::string unknown = switchOn(kinds, scene);
  if (!unknown.empty())
    throw SceneError(
        fmt::format("--truth: \"{}\" is not a kind of truth, accepted: {}", unknown, kTruthKinds));
}

// Times are summed over threads, so that settings compare whatever the number of cores.
void printSummary(const RenderSummary& summary, const RenderOptions& options, const Scene& scene) {
  const Manifest& m = summary.manifest;
  fmt::print("{} frame{} in {}: {:.1f} frames/s on {}\n", summary.frames_done,
             summary.frames_done == 1 ? "" : "s", options.folder.string(), 1000 / m.wall_ms,
             options.threads > 0 ? fmt::format("{} thread(s)", options.threads) : "all cores");
  std::string stages;
  for (std::size_t s = 0; s < kStages; ++s)
    stages +=
        fmt::format("{}{} {:.2f}", s ? ", " : "", stageName(static_cast<Stage>(s)), m.stage_ms[s]);
  fmt::print("  plan: {}\n", planSummary(m.plan));
  fmt::print("  ms per frame and thread: {}\n", stages);
  std::string parts;
  const auto add = [&](const std::string& part) { parts += (parts.empty() ? "" : ", ") + part; };
  if (scene.output.exr) add("intensity/frame_*.exr");
  if (scene.output.cine) add("cine.avi");
  if (scene.output.dicom) add("cine.dcm");
  if (scene.output.png) add("png/frame_*.png");
  if (scene.truth.any()) add("truth/");
  if (scene.output.volumes && hasChambers(scene)) add("volumes.csv");
  if (scene.output.report) add("report.html");
  add("manifest.json");
  fmt::print("  {}\n", parts);
}

}  // namespace

RenderCommand::RenderCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("render", "Render a scene's cine loop: EXR intensities and an AVI");
  command->add_option("scene", scene_file_, "Scene file (TOML; each key carries its unit)")
      ->required();
  command
      ->add_option("-o,--output", options_.folder,
                   "Folder for intensity/, cine.avi, report.html and manifest.json")
      ->required();
  command->add_option("--threads", options_.threads, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_option("--frames", frames_,
                      "Only frames A to B - 1 of the loop, counted from 0 (A:B, A:, :B)");
  command->add_option(
      "--truth", truth_,
      "Write more ground truth than the scene requests: all (as far as its structures allow), or a "
      "comma-separated list of labels, contours, tracks, function");
  command->add_flag("--dicom", dicom_,
                    "Also write cine.dcm, a DICOM ultrasound loop (output.dicom = true)");
  accuracy_.addTo(*command);
  command->add_flag("--resume", options_.resume,
                    "Keep frames whose EXR is complete and belongs to this scene");
  command->add_flag("--overwrite", options_.overwrite,
                    "Replace the loop of another scene in the folder");
  command->add_flag("--quiet", quiet_, "Print errors only");
  command->footer("Example: echocine render scene.toml -o loop --frames 0:50\n" +
                  std::string(kDocuments));
}

int RenderCommand::run() {
  try {
    return renderAndTell();
  } catch (const Stopped&) {
    throw JobError(
        fmt::format("stopped: the loop in {} is not finished; --resume continues from there",
                    options_.folder.string()));
  }
}

int RenderCommand::renderAndTell() {
  Scene scene = placed(readScene(scene_file_));
  askForTruth(truth_, scene);
  scene.output.dicom |= dicom_;
  if (!frames_.empty()) options_.frames = parseRange(frames_, CardiacClock(scene).frameCount());
  checkOutputFolder(options_.folder, {"manifest.json"});
  options_.accuracy = accuracy_.resolve(scene, options_.threads, quiet_);
  ProgressLine line(quiet_);
  const RenderSummary summary = renderLoop(scene, options_, line.monitor());
  line.finish();
  // A stopped run is a failed job: scripts must not go on with half a loop.
  if (summary.frames_done < summary.frames_wanted)
    throw JobError(
        fmt::format("stopped: {} of {} frames are finished in {}; --resume continues from there",
                    summary.frames_done, summary.frames_wanted, options_.folder.string()));
  if (quiet_) return 0;
  printSummary(summary, options_, scene);
  return 0;
}

}  // namespace echocine
