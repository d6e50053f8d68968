#include "cli/export_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include "cli/documents.h"
#include "cli/enum_names.h"
#include "cli/warning_printer.h"
#include "scene/names.h"

namespace echocine {

ExportCommand::ExportCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("export", "Write loops as MP4, GIF or animated WebP, side by side");
  command
      ->add_option("loops", options_.loops,
                   "Folders of renders, videos or DICOM files; videos show the sector only")
      ->required();
  command
      ->add_option("-o,--output", options_.output,
                   "File to write: .mp4, .gif or .webp; an existing file is replaced")
      ->required();
  command->add_option("--captions", options_.captions, "Caption of each loop, in their order");
  command->add_option("--columns", options_.columns,
                      "Columns of the grid; default 0: a nearly square grid");
  command->add_option("--width", options_.width,
                      "Width of each loop, pixels; default 0: that of the first loop");
  command
      ->add_option("--speed", options_.speed,
                   "Speed of playback; 0.5 shows the loop at half of its speed")
      ->capture_default_str();
  command
      ->add_option("--repeats", options_.repeats,
                   "Number of times that an MP4 shows the loop; GIF and WebP repeat without end")
      ->capture_default_str();
  command->add_option("--fps", options_.fps,
                      "Frame rate of the loops, frames/s; default: that of each file");
  command->add_option("--tint", tint_, "Colour of the grey levels")
      ->check(CLI::IsMember(enumNames<Tint>()))
      ->capture_default_str();
  command->add_option("--threads", options_.threads, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", quiet_, "Print errors only");
  command->footer("Example: echocine export out/a4c out/plax --captions A4C PLAX -o views.mp4\n" +
                  std::string(kDocuments));
}

int ExportCommand::run() {
  options_.tint = valueOf<Tint>(tint_).value();
  const Exported exported = exportLoops(options_);
  const auto warn = warningPrinter(quiet_);
  for (const std::string& note : exported.notes) warn(note);
  if (!quiet_)
    fmt::print("{}: {}, {} x {} pixels, {} frames at {:.4g} a second\n", options_.output.string(),
               exported.codec, exported.width, exported.height, exported.frames,
               exported.frame_rate_hz);
  return 0;
}

}  // namespace echocine
