#include "cli/mmode_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/documents.h"
#include "cli/enum_names.h"
#include "cli/progress_line.h"
#include "core/stop.h"
#include "scene/names.h"
#include "scene/scene_reader.h"

namespace echocine {

MModeCommand::MModeCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("mmode", "Write an M-mode: the echoes of one scan line over time");
  command->add_option("scene", scene_file_, "Scene file (TOML; each key carries its unit)")
      ->required();
  command
      ->add_option("-o,--output", options_.folder,
                   "Folder for mmode.exr, mmode.png, borders.csv and mmode.json")
      ->required();
  CLI::Option* angle = command->add_option(
      "--angle", angle_deg_,
      "Angle of the line, degrees from the probe's axis; the nearest scan line is used; default: "
      "the central line");
  CLI::Option* offset =
      command->add_option("--offset", offset_mm_, "Linear probes: lateral offset of the line, mm");
  CLI::Option* through =
      command
          ->add_option("--through", through_,
                       "Line through this place of the heart at end-diastole; for a ring, the "
                       "excursion is measured")
          ->check(CLI::IsMember(enumNames<MModeTarget>()));
  angle->excludes(offset)->excludes(through);
  offset->excludes(through);
  command->add_option("--rate", options_.request.rate_hz, "Lines a second, Hz")
      ->capture_default_str();
  command->add_option("--rows", options_.rows, "Height of the echoes in the picture, pixels")
      ->check(CLI::Range(16, 8192))
      ->capture_default_str();
  command->add_option("--threads", options_.threads, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", quiet_, "Print errors only");
  command->footer("Example: echocine mmode scene.toml -o tapse --through tricuspid-lateral\n" +
                  std::string(kDocuments));
}

int MModeCommand::run() {
  MModeRequest& request = options_.request;
  if (!through_.empty()) request.through = valueOf<MModeTarget>(through_);
  const Scene scene = readScene(scene_file_);
  request.place = placeGiven(scene.probe, angle_deg_, offset_mm_);
  ProgressLine progress(quiet_);
  const MMode mode = writeMMode(scene, options_, progress.monitor());
  progress.finish();
  if (quiet_) return 0;
  fmt::print("{}: {} columns at {:g} Hz, scan line {}\n", options_.folder.string(), mode.columns,
             request.rate_hz, mode.line);
  if (mode.ring)
    fmt::print(
        "  excursion of the ring along the line: {:.1f} mm, measured in the picture {:.1f} mm; "
        "in space {:.1f} mm\n",
        mode.ring->exact_mm, mode.ring->traced_mm, mode.ring->in_space_mm);
  return 0;
}

}  // namespace echocine
