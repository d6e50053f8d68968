#include "cli/compare_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "cli/compare_tables.h"
#include "cli/documents.h"
#include "cli/number_check.h"
#include "cli/progress_line.h"
#include "cli/view_list.h"
#include "compare/results.h"
#include "core/error.h"
#include "core/output_check.h"
#include "core/parallel.h"
#include "core/units.h"
#include "fit/fit_report.h"
#include "video/video.h"

namespace echocine {

namespace {

void addSide(CLI::App& command, echo::SideOptions& side, const std::string& prefix,
             const char* which) {
  const auto help = [&](const char* what) { return fmt::format("{} loop: {}", which, what); };
  command
      .add_option("--" + prefix + "fps", side.fps,
                  help("frame rate of the acquisition, frames/s, 0.5 to 10000"))
      ->check(within(kLeastFrameRate_hz, kMostFrameRate_hz))
      ->type_name("NUMBER");
  command
      .add_option("--" + prefix + "scale", side.mm_per_pixel,
                  help("length scale, mm per pixel, 0.001 to 100"))
      ->check(within(echo::kLeastScale_mm, echo::kMostScale_mm))
      ->type_name("NUMBER");
  command
      .add_option("--" + prefix + "sector", side.sector,
                  help("sector in pixels and degrees from straight down: "
                       "apex_x,apex_y,first_deg,last_deg,r_min,r_max"))
      ->expected(1);
  command
      .add_option("--" + prefix + "label", side.label,
                  help("its name in pages and JSON, which never contain a file name"))
      ->type_name("TEXT");
  command
      .add_option("--" + prefix + "pixel-aspect", side.pixel_aspect,
                  help("pixel height / width, if the picture is stretched"))
      ->check(within(echo::kLeastAspect, echo::kMostAspect))
      ->type_name("NUMBER");
  command
      .add_option("--" + prefix + "heart-rate", side.heart_rate_bpm,
                  help("beats per minute, 10 to 400"))
      ->check(within(echo::kLeastHeartRate_bpm, echo::kMostHeartRate_bpm))
      ->type_name("NUMBER");
}

void addTimes(CLI::App& command, echo::SideOptions& side, const std::string& prefix,
              const char* which) {
  const auto help = [&](const char* what) { return fmt::format("{} loop: {}", which, what); };
  command.add_option("--" + prefix + "-ed", side.ed_frame, help("frame of end-diastole, from 0"))
      ->check(within(0, echo::kMostFrame))
      ->type_name("NUMBER");
  command.add_option("--" + prefix + "-es", side.es_frame, help("frame of end-systole, from 0"))
      ->check(within(0, echo::kMostFrame))
      ->type_name("NUMBER");
  command
      .add_option("--" + prefix + "-r-waves", side.r_waves_s,
                  help("times of its R waves, s from the first frame: a,b,..."))
      ->check(within(0, echo::kMostRWave_s))
      ->type_name("NUMBER")
      ->delimiter(',');
}

// Checks combinations of options, because the parser checks each of them alone.
void checkOptions(const compare::CompareOptions& o) {
  if (o.contours && o.scene.empty())
    throw SceneError(
        "--contours: needs --scene, the scene that the synthetic loop was rendered from");
  for (std::size_t i = 1; i < o.knots.size(); ++i)
    if (!(o.knots[i] > o.knots[i - 1]))
      throw SceneError("--knots: must ascend, such as 0,40,90,160,255");
  if (o.knots.size() == 1)
    throw SceneError("--knots: needs two greys or more, such as 0,40,90,160,255");
}

}  // namespace

CompareCommand::CompareCommand(CLI::App& app)
    : command_(app.add_subcommand("compare",
                                  "Compare a synthetic loop with an echo video, frame by frame")) {
  CLI::App* const command = command_;
  command
      ->add_option("synthetic", options_.synthetic,
                   "Folder of a render, or any video; omitted with --scan and --views")
      ->required();
  command->add_option(
      "real", options_.real,
      "AVI, MP4, GIF, DICOM, a folder of PNG or JPEG frames, EchoXFlow (.zarr), or zea (.hdf5)");
  command->add_option("-o,--output", folder_, "Folder for the results")->required();
  addSide(*command, options_.real_side, "", "real");
  addTimes(*command, options_.real_side, "real", "real");
  addSide(*command, options_.synthetic_side, "synthetic-", "synthetic");
  addTimes(*command, options_.synthetic_side, "synthetic", "synthetic");
  command->add_flag(
      "--sectors-only", no_space_,
      "Align the loops by their sectors only; do not search shift, scale and rotation");
  command->add_flag("--no-ecg", no_ecg_, "Do not read an ECG from the pictures");
  command->add_flag("--monotone", options_.monotone, "Use a monotone grey calibration");
  CLI::Option* count = command
                           ->add_option("--knot-count", options_.knot_count,
                                        "Number of knots of the grey calibration")
                           ->check(CLI::Range(2, 64))
                           ->capture_default_str();
  command->add_option("--knots", options_.knots, "Synthetic grey levels (0 to 255) of the knots")
      ->excludes(count)
      ->delimiter(',')
      ->check(within(0, 255))
      ->type_name("NUMBER");
  command->add_option(
      "--scene", options_.scene,
      "Scene of the render: adds metrics in bands around its boundaries, and finds its best pose");
  command->add_option("--band-mm", options_.band_mm, "Full width of these bands, mm")
      ->check(within(0.1, 100))
      ->type_name("NUMBER")
      ->capture_default_str();
  command
      ->add_option(
          "--tilt", options_.tilt_deg,
          fmt::format("Largest tilt and rotation of the imaging plane to search, degrees either "
                      "way, 0 to {:g}; with --scene, --scan or --views",
                      fit::kMostTilt_deg))
      ->check(within(0, fit::kMostTilt_deg))
      ->type_name("NUMBER")
      ->capture_default_str();
  command->add_flag("--contours", options_.contours, "Draw the scene's contours into the pictures");
  command->add_option(
      "--scan", scan_text_,
      "Instead of a synthetic loop: evaluate a grid of up to three dials of a parametric heart, "
      "such as ef=0.3:0.75:0.05,edv=120:230:20");
  command->add_option(
      "--views", views_text_,
      "Instead of a synthetic loop: fit a heart in each of these views and rank them; all, "
      "or at least two of " +
          viewList());
  command->add_option("--dials", dials_text_,
                      "Fixed dials of the hearts of --scan or --views, such as "
                      "hr=72,wall-thickness=11");
  command->add_option("--view", view_text_, "View of the hearts of --scan, as in `echocine heart`")
      ->type_name(viewChoice())
      ->capture_default_str();
  command->add_flag("--yes", scan_.yes,
                    fmt::format("Allow scans of more than {} points", fit::kMostUnasked));
  command->add_option("--threads", threads_, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", quiet_, "Print errors only");
  command->footer("Example: echocine compare loop patient.dcm -o comparison --heart-rate 62.5\n" +
                  std::string(kDocuments));
}

template <typename Make, typename Write>
int CompareCommand::runAndTell(const char* last, const Make& make, const Write& write) const {
  checkOutputFolder(folder_, {last});
  ProgressLine line(quiet_);
  withThreads(threads_, [&] {
    const auto result = make(line.monitor());
    line.finish();
    write(result, folder_);
    if (!quiet_) printTable(result, folder_);
  });
  return 0;
}

int CompareCommand::run() {
  if (!scan_text_.empty() && !views_text_.empty())
    throw SceneError("--views: cannot be combined with --scan; give one of the two");
  if (!scan_text_.empty()) return runScan();
  for (const char* of_scan : {"--yes", "--view"})
    if (command_->get_option(of_scan)->count() > 0)
      throw SceneError("--view and --yes: belong to --scan");
  if (!views_text_.empty()) return runViews();
  if (options_.real.empty())
    throw SceneError(
        "compare: needs two loops, SYNTHETIC and REAL; with --scan or --views only the real one");
  if (options_.scene.empty() && command_->get_option("--band-mm")->count() > 0)
    throw SceneError("--band-mm: needs --scene, whose boundaries have the bands");
  if (!dials_text_.empty()) throw SceneError("--dials: is accepted with --scan or --views only");
  // A flag that leaves out reads better than one that turns on what is on.
  options_.align_space = !no_space_;
  options_.real_side.read_ecg = options_.synthetic_side.read_ecg = !no_ecg_;
  checkOptions(options_);
  return runAndTell(
      "summary.json", [&](const auto& monitor) { return compareLoops(options_, monitor); },
      [&](const auto& comparison, const auto& to) { writeResults(comparison, options_, to); });
}

void CompareCommand::needOneLoop(const char* option) const {
  if (!options_.real.empty())
    throw SceneError(fmt::format("{}: takes only the real loop; omit the synthetic one", option));
  if (!options_.scene.empty())
    throw SceneError(fmt::format("{}: uses its own hearts; omit --scene", option));
  // These options compare two loops.
  for (const CLI::Option* other : command_->get_options()) {
    const std::string name = other->get_name();
    const bool of_two = name.starts_with("--synthetic-") || name == "--contours" ||
                        name == "--knots" || name == "--knot-count" || name == "--monotone" ||
                        name == "--band-mm" || name == "--sectors-only";
    if (of_two && other->count() > 0)
      throw SceneError(fmt::format("{}: cannot be combined with {}", name, option));
  }
}

// One loop stands first, whatever the position is called.
int CompareCommand::runScan() {
  needOneLoop("--scan");
  const auto view = heart::viewOf(view_text_);
  if (!view)
    throw SceneError(
        fmt::format("--view: \"{}\" is not a view, accepted: {}", view_text_, viewList()));
  scan_.view = *view;
  scan_.axes = fit::parseScan(scan_text_);
  scan_.dials = fit::parseDials(dials_text_);
  scan_.real = options_.synthetic;
  scan_.side = options_.real_side;
  scan_.side.read_ecg = !no_ecg_;
  scan_.tilt_deg = options_.tilt_deg;
  return runAndTell(
      "scan.json", [&](const auto& monitor) { return scanDials(scan_, monitor); }, fit::writeScan);
}

int CompareCommand::runViews() {
  needOneLoop("--views");
  fit::ViewsOptions options;
  options.views = fit::parseViews(views_text_);
  options.dials = fit::parseDials(dials_text_);
  options.real = options_.synthetic;
  options.side = options_.real_side;
  options.side.read_ecg = !no_ecg_;
  options.tilt_deg = options_.tilt_deg;
  return runAndTell(
      "views.json", [&](const auto& monitor) { return rankViews(options, monitor); },
      fit::writeViews);
}

}  // namespace echocine
