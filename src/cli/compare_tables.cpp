#include "cli/compare_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "core/units.h"
#include "fit/fit_report.h"

namespace echocine {

namespace {

void printTilt(const fit::TiltFound& t) {
  const auto degrees = [](double rad) { return rad / radiansFromDegrees(1); };
  fmt::print(
      "  tilt: {:.1f} deg, confidence {:.2f}; rotation {:.1f} deg, confidence {:.2f}; the model's "
      "discrepancy {:.4f}, {:.4f} without tilt; {} planes, {:.1f} s of one core\n",
      degrees(t.tilt.tilt_rad), t.tilt_confidence, degrees(t.tilt.rotate_rad), t.rotate_confidence,
      t.found.discrepancy, t.untilted, t.planes, 1e-3 * t.cpu_ms);
}

// Beside the result: a reader of the first lines must not miss them.
void printCaveats(const std::vector<std::string>& caveats) {
  for (const std::string& caveat : caveats) fmt::print("  {}\n", caveat);
}

void printSceneFit(const fit::SceneFit& fit) {
  fmt::print("  scene: discrepancy {:.4f} at its best pose, confidence {:.2f}\n",
             fit.found.discrepancy, fit.found.confidence);
  printCaveats(fit.caveats);
  if (fit.tilt) printTilt(*fit.tilt);
}

void printBeat(const echo::EchoLoop& real) {
  fmt::print("  beat: {}", real.beat_anchor);
  if (real.ecg)
    fmt::print(", {}, {} R waves, {:.2f} px per frame, confidence {:.2f}", real.ecg->kind,
               real.rWaveFrames().size(), real.ecg->px_per_frame, real.ecg->confidence);
  fmt::print("\n");
}

}  // namespace

// The one number first: it is what optimisers and impatient readers want.
void printTable(const compare::Comparison& c, const std::filesystem::path& folder) {
  fmt::print(
      "discrepancy {:.4f} (0 equal, about 1 unrelated), mean of {} frames; {:.4f} without "
      "registration\n",
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
  row("greys as displayed", c.mean_before);
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
  if (c.scene_fit) printSceneFit(*c.scene_fit);
  fmt::print(
      "  {}: compare.html, frames.csv, summary.json, side_by_side.avi, sector_real.png, "
      "sector_synthetic.png\n",
      folder.string());
}

void printTable(const fit::DialScan& scan, const std::filesystem::path& folder) {
  const fit::ScanPoint& best = scan.points[scan.best];
  std::string where, between;
  for (std::size_t a = 0; a < best.values.size(); ++a) {
    const std::string& key = scan.options.axes[a].range.key;
    where += fmt::format("{}{} {:g}", a > 0 ? ", " : "", key, best.values[a]);
    if (!scan.minimum.empty())
      between += fmt::format("{}{} {:.4g}", a > 0 ? ", " : "", key, scan.minimum[a]);
  }
  printCaveats(scan.caveats);
  const fit::FitTerms& t = best.found.terms;
  fmt::print("discrepancy {:.4f} at {}{}\n", best.found.discrepancy, where,
             between.empty() ? "" : "; minimum between the grid points at " + between);
  fmt::print("  region {:.3f}, boundary {:.3f}, motion {:.3f}, {:.0f} % overlap\n", t.region,
             t.boundary, t.motion, 100 * t.overlap);
  const fit::FitPose& p = best.found.pose;
  fmt::print("  pose: shift {:.1f}, {:.1f} mm, turn {:.1f} deg, scale {:.3f}, confidence {:.2f}\n",
             1e3 * p.shift_x_m, 1e3 * p.shift_z_m, p.turn_rad / radiansFromDegrees(1), p.scale,
             scan.centre.confidence);
  if (scan.tilt) printTilt(*scan.tilt);
  fmt::print("  beat: {}\n", scan.beat_anchor);
  fmt::print("  {} evaluations of {:.0f} ms of one core, hearts computed in {:.1f} s of one core\n",
             scan.points.size(), scan.evaluation_ms, 1e-3 * scan.family_ms);
  fmt::print("  {}: scan.csv, scan.json, scan.html\n", folder.string());
}

void printTable(const fit::ViewRanking& ranking, const std::filesystem::path& folder) {
  const fit::ViewFound& best = ranking.views.front();
  fmt::print("best view {}; V is {:.4f} lower than for {}, confidence {:.2f}\n", keyOf(best.view),
             ranking.margin, keyOf(ranking.views[1].view), ranking.confidence);
  printCaveats(ranking.caveats);
  std::string head = fmt::format("  {:<10}", "");
  for (const char* name : {"V", "coverage", "D", "region", "boundary", "motion", "overlap"})
    head += fmt::format("{:>9}", name);
  for (const fit::ScanAxis& d : ranking.population) head += fmt::format("{:>7}", d.range.key);
  fmt::print("{}  pose: mm, deg\n", head);
  for (const fit::ViewFound& v : ranking.views) {
    const fit::PoseFound& f = v.heart.found;
    std::string line = fmt::format("  {:<10}", keyOf(v.view));
    for (const double value : {v.heart.left, v.heart.coverage, f.discrepancy, f.terms.region,
                               f.terms.boundary, f.terms.motion, f.terms.overlap})
      line += fmt::format("{:9.3f}", value);
    for (const double value : v.heart.values) line += fmt::format("{:7.3g}", value);
    fmt::print("{}  {:6.1f},{:6.1f},{:6.1f}\n", line, 1e3 * f.pose.shift_x_m,
               1e3 * f.pose.shift_z_m, f.pose.turn_rad / radiansFromDegrees(1));
  }
  if (best.heart.tilt) printTilt(*best.heart.tilt);
  fmt::print("  beat: {}\n", ranking.beat_anchor);
  fmt::print("  {:.0f} s of one core, {:.0f} s of it for computing hearts\n", 1e-3 * ranking.cpu_ms,
             1e-3 * ranking.nodes_ms);
  fmt::print("  {}: views.csv, views.json, views.html\n", folder.string());
}

}  // namespace echocine
