#include "cli/compare_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>

#include "cli/documents.h"
#include "cli/number_check.h"
#include "cli/progress_line.h"
#include "cli/stop_signal.h"
#include "cli/view_list.h"
#include "compare/fit_where.h"
#include "compare/results.h"
#include "core/error.h"
#include "core/parallel.h"
#include "core/units.h"
#include "video/video.h"

namespace echocine {

namespace {

constexpr double kMostFrame = 1e6;

void addSide(CLI::App& command, compare::SideOptions& side, const std::string& prefix,
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
      ->check(within(1e-3, 100))
      ->type_name("NUMBER");
  command
      .add_option("--" + prefix + "sector", side.sector,
                  help("sector in pixels and degrees from straight down: "
                       "apex_x,apex_y,first_deg,last_deg,r_min,r_max"))
      ->expected(1);
  command
      .add_option("--" + prefix + "pixel-aspect", side.pixel_aspect,
                  help("height of a pixel over its width, where the picture is stretched"))
      ->check(within(0.2, 5))
      ->type_name("NUMBER");
  command
      .add_option("--" + prefix + "heart-rate", side.heart_rate_bpm,
                  help("beats per minute, 10 to 400"))
      ->check(within(10, 400))
      ->type_name("NUMBER");
}

void addTimes(CLI::App& command, compare::SideOptions& side, const std::string& prefix,
              const char* which) {
  const auto help = [&](const char* what) { return fmt::format("{} loop: {}", which, what); };
  command.add_option("--" + prefix + "-ed", side.ed_frame, help("frame of end-diastole, from 0"))
      ->check(within(0, kMostFrame))
      ->type_name("NUMBER");
  command.add_option("--" + prefix + "-es", side.es_frame, help("frame of end-systole, from 0"))
      ->check(within(0, kMostFrame))
      ->type_name("NUMBER");
  command
      .add_option("--" + prefix + "-r-waves", side.r_waves_s,
                  help("times of its R waves, s from the first frame: a,b,..."))
      ->check(within(0, 3600))
      ->type_name("NUMBER")
      ->delimiter(',');
}

// What one option says of another: the parser looks at each alone.
void checkOptions(const compare::CompareOptions& o) {
  if (o.contours && o.scene.empty())
    throw SceneError(
        "--contours: needs --scene, the scene that the synthetic loop was rendered from");
  for (std::size_t i = 1; i < o.knots.size(); ++i)
    if (!(o.knots[i] > o.knots[i - 1]))
      throw SceneError("--knots: must rise, such as 0,40,90,160,255");
  if (o.knots.size() == 1)
    throw SceneError("--knots: needs two greys or more, such as 0,40,90,160,255");
}

void print(const compare::TiltFound& t) {
  const auto degrees = [](double rad) { return rad / radiansFromDegrees(1); };
  fmt::print(
      "  tilt: {:.1f} deg, confidence {:.2f}; rotation {:.1f} deg, confidence {:.2f}; the model's "
      "discrepancy {:.4f}, {:.4f} untilted; {} planes, {:.1f} s of a core\n",
      degrees(t.tilt.tilt_rad), t.tilt_confidence, degrees(t.tilt.rotate_rad), t.rotate_confidence,
      t.found.discrepancy, t.untilted, t.planes, 1e-3 * t.cpu_ms);
}

void printBeat(const compare::Loop& real) {
  fmt::print("  beat: {}", real.beat_anchor);
  if (real.ecg)
    fmt::print(", {}, {} R waves, {:.2f} px a frame, confidence {:.2f}", real.ecg->kind,
               real.rWaveFrames().size(), real.ecg->px_per_frame, real.ecg->confidence);
  fmt::print("\n");
}

// The one number first: it is what optimisers and impatient readers want.
void print(const compare::Comparison& c, const std::filesystem::path& folder) {
  fmt::print(
      "discrepancy {:.4f} (0 equal, about 1 unrelated), mean of {} frames; {:.4f} as placed\n",
      c.discrepancy,
      std::count_if(c.frames.begin(), c.frames.end(), [](const auto& f) { return f.counted(); }),
      c.discrepancy_as_placed);
  std::string head = fmt::format("  {:<22}", "");
  for (const Metric& metric : kMetrics)
    if (*metric.column) head += fmt::format("{:>8}", metric.column);
  fmt::print("{}\n", head);
  const auto row = [](const std::string& name, const FrameMetrics& m) {
    std::string line = fmt::format("  {:<22}", name);
    for (const Metric& metric : kMetrics)
      if (*metric.column) line += fmt::format("{:8.{}f}", m.*metric.value, metric.decimals);
    fmt::print("{}\n", line);
  };
  row("greys as they are", c.mean_before);
  row("greys calibrated", c.mean_after);
  for (const auto& band : c.mean_bands)
    if (band.metrics.weight > 0) row("  band: " + band.structure, band.metrics);
  fmt::print("  time: {}, shift {:.2f} frames, pace {:.3f}, confidence {:.2f}\n", c.time.method,
             c.time.shift_frames, c.time.rate, c.time.confidence);
  printBeat(c.real);
  const auto& p = c.space.placement;
  fmt::print(
      "  space: {}, shift {:.2f}, {:.2f} px, scale {:.4f}, rotation {:.2f} deg{}, confidence "
      "{:.2f}\n",
      c.space.method, p.shift_x_px, p.shift_y_px, p.scale, p.rotation_rad / radiansFromDegrees(1),
      c.space.used ? "" : " not used", c.space.confidence);
  if (c.scene_fit && c.scene_fit->tilt) print(*c.scene_fit->tilt);
  fmt::print(
      "  {}: compare.html, frames.csv, summary.json, side_by_side.avi, sector_real.png, "
      "sector_synthetic.png\n",
      folder.string());
}

void print(const compare::DialScan& scan, const std::filesystem::path& folder) {
  const compare::ScanPoint& best = scan.points[scan.best];
  std::string where, between;
  for (std::size_t a = 0; a < best.values.size(); ++a) {
    const std::string& key = scan.options.axes[a].range.key;
    where += fmt::format("{}{} {:g}", a > 0 ? ", " : "", key, best.values[a]);
    if (!scan.minimum.empty())
      between += fmt::format("{}{} {:.4g}", a > 0 ? ", " : "", key, scan.minimum[a]);
  }
  const compare::FitTerms& t = best.found.terms;
  fmt::print("discrepancy {:.4f} at {}{}\n", best.found.discrepancy, where,
             between.empty() ? "" : "; between the steps least at " + between);
  fmt::print("  region {:.3f}, boundary {:.3f}, motion {:.3f}, {:.0f} % in sight\n", t.region,
             t.boundary, t.motion, 100 * t.in_sight);
  const compare::FitPose& p = best.found.pose;
  fmt::print("  pose: shift {:.1f}, {:.1f} mm, turn {:.1f} deg, scale {:.3f}, confidence {:.2f}\n",
             1e3 * p.shift_x_m, 1e3 * p.shift_z_m, p.turn_rad / radiansFromDegrees(1), p.scale,
             scan.centre.confidence);
  if (scan.tilt) print(*scan.tilt);
  fmt::print("  beat: {}\n", scan.beat_anchor);
  fmt::print("  {} evaluations of {:.0f} ms of a core, hearts recorded in {:.1f} s of a core\n",
             scan.points.size(), scan.evaluation_ms, 1e-3 * scan.family_ms);
  fmt::print("  {}: scan.csv, scan.json, scan.html\n", folder.string());
}

}  // namespace

CompareCommand::CompareCommand(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("compare", "Compare a synthetic loop with an echo video, frame by frame");
  command
      ->add_option("synthetic", options_.synthetic,
                   "Folder of a render, or any video; left out with --scan")
      ->required();
  command->add_option("real", options_.real,
                      "AVI, MP4, GIF, DICOM, or a folder of PNG or JPEG frames");
  command->add_option("-o,--output", folder_, "Folder for the results")->required();
  addSide(*command, options_.real_side, "", "real");
  addTimes(*command, options_.real_side, "real", "real");
  addSide(*command, options_.synthetic_side, "synthetic-", "synthetic");
  addTimes(*command, options_.synthetic_side, "synthetic", "synthetic");
  command->add_flag("--sectors-only", no_space_,
                    "Lay the sectors on one another and shift, scale and turn nothing");
  command->add_flag("--no-ecg", no_ecg_, "Read no ECG from the pictures of either loop");
  command->add_flag("--monotone", options_.monotone, "A grey calibration that never falls");
  command->add_option("--knot-count", options_.knot_count, "Knots of the grey calibration")
      ->check(CLI::Range(2, 64))
      ->capture_default_str();
  command->add_option("--knots", options_.knots, "Synthetic greys (0 to 255) to put the knots at")
      ->delimiter(',')
      ->check(within(0, 255))
      ->type_name("NUMBER");
  command->add_option("--scene", options_.scene,
                      "Scene of the render: metrics in bands about its boundaries");
  command->add_option("--band-mm", options_.band_mm, "Full width of a band, mm")
      ->check(within(0.1, 100))
      ->type_name("NUMBER")
      ->capture_default_str();
  command
      ->add_option(
          "--tilt", options_.tilt_deg,
          fmt::format("Tilt and rotate the plane of --scene, or of the heart of --scan, to "
                      "where it fits best: degrees either way, 0 to {:g}",
                      compare::kMostTilt_deg))
      ->check(within(0, compare::kMostTilt_deg))
      ->type_name("NUMBER")
      ->capture_default_str();
  command->add_flag("--contours", options_.contours, "Draw the scene's contours into the pictures");
  command->add_option(
      "--scan", scan_text_,
      "Instead of a synthetic loop: a parametric heart whose dials are changed, up to "
      "three, such as ef=0.3:0.75:0.05,edv=120:230:20");
  command->add_option("--dials", dials_text_,
                      "Dials of that heart that stay, such as hr=72,wall-thickness=11");
  command->add_option("--view", view_text_, "View of that heart, as `echocine heart` has them")
      ->capture_default_str();
  command->add_flag("--yes", scan_.yes,
                    fmt::format("Scan also at more than {} places", compare::kMostUnasked));
  command->add_option("--threads", threads_, "Threads; default 0: one per core")
      ->check(CLI::Range(0, 4096));
  command->add_flag("--quiet", quiet_, "Print nothing but errors");
  command->footer("Example: echocine compare loop patient.dcm -o comparison --heart-rate 62.5\n" +
                  std::string(kDocuments));
}

int CompareCommand::run() {
  if (!scan_text_.empty()) return runScan();
  if (options_.real.empty())
    throw SceneError(
        "compare: needs two loops, SYNTHETIC and REAL; with --scan the real one alone");
  for (const bool given : {!dials_text_.empty(), scan_.yes, view_text_ != "a4c"})
    if (given) throw SceneError("--dials, --view and --yes: belong to --scan");
  // A flag that leaves out reads better than one that turns on what is on.
  options_.align_space = !no_space_;
  options_.real_side.read_ecg = options_.synthetic_side.read_ecg = !no_ecg_;
  checkOptions(options_);
  listenForStop();
  ProgressLine line(quiet_);
  withThreads(threads_, [&] {
    const compare::Comparison comparison = compareLoops(options_, line.monitor());
    line.finish();
    writeResults(comparison, options_, folder_);
    if (!quiet_) print(comparison, folder_);
  });
  return 0;
}

// One loop stands first, whatever the position is called.
int CompareCommand::runScan() {
  if (!options_.real.empty())
    throw SceneError("--scan: takes the real loop alone; leave the synthetic one out");
  const auto view = heart::viewOf(view_text_);
  if (!view)
    throw SceneError(
        fmt::format("--view: \"{}\" is not a view, accepted: {}", view_text_, viewList()));
  scan_.view = *view;
  scan_.axes = compare::parseScan(scan_text_);
  scan_.dials = compare::parseDials(dials_text_);
  scan_.real = options_.synthetic;
  scan_.side = options_.real_side;
  scan_.side.read_ecg = !no_ecg_;
  scan_.tilt_deg = options_.tilt_deg;
  listenForStop();
  ProgressLine line(quiet_);
  withThreads(threads_, [&] {
    const compare::DialScan scan = scanDials(scan_, line.monitor());
    line.finish();
    writeScan(scan, folder_);
    if (!quiet_) print(scan, folder_);
  });
  return 0;
}

}  // namespace echocine
