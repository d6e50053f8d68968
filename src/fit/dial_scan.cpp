#include "fit/dial_scan.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "fit/caveats.h"
#include "fit/cpu_seconds.h"
#include "fit/option_list.h"
#include "fit/searched_dials.h"
#include "motion/heart/heart_scene.h"
#include "motion/heart/parameters.h"
#include "motion/heart/recording.h"
#include "scene/view_names.h"

namespace echocine::fit {

namespace {

// from_chars knows no locale, in which 0.5 might end at the point.
double numberOf(const std::string& option, const std::string& text) {
  double value = 0;
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value))
    throw SceneError(fmt::format("{}: \"{}\" is not a number", option, text));
  return value;
}

}  // namespace

std::vector<ScanAxis> parseScan(const std::string& text) {
  std::vector<ScanAxis> axes;
  for (const std::string& part : splitOption(text, ',')) {
    const std::vector<std::string> sides = splitOption(part, '=');
    const std::vector<std::string> numbers = splitOption(sides.back(), ':');
    if (sides.size() != 2 || numbers.size() != 3)
      throw SceneError(fmt::format(
          "--scan: \"{}\" is not accepted: DIAL=LOW:HIGH:STEP, such as ef=0.3:0.75:0.05", part));
    const heart::Dial& dial = dialOf("--scan", sides[0]);
    ScanAxis axis{{sides[0], numberOf("--scan", numbers[0]), numberOf("--scan", numbers[1])},
                  numberOf("--scan", numbers[2])};
    checkDial("--scan", dial, axis.range.low);
    checkDial("--scan", dial, axis.range.high);
    if (!(axis.step > 0 && axis.step <= (axis.range.high - axis.range.low) * (1 + 1e-9)))
      throw SceneError(fmt::format(
          "--scan: {} must go up by a step of at most its range, such as ef=0.3:0.75:0.05", part));
    for (const ScanAxis& other : axes)
      if (other.range.key == axis.range.key)
        throw SceneError(fmt::format("--scan: {} is given twice", axis.range.key));
    axes.push_back(axis);
  }
  if (axes.size() > kMostAxes)
    throw SceneError(fmt::format("--scan: {} dials, accepted: 1 to {}", axes.size(), kMostAxes));
  return axes;
}

std::map<std::string, double> parseDials(const std::string& text) {
  std::map<std::string, double> out;
  if (text.empty()) return out;
  for (const std::string& part : splitOption(text, ',')) {
    const std::vector<std::string> sides = splitOption(part, '=');
    if (sides.size() != 2)
      throw SceneError(fmt::format(
          "--dials: \"{}\" is not accepted: DIAL=VALUE, such as hr=72,wall-thickness=11", part));
    const double value = numberOf("--dials", sides[1]);
    checkDial("--dials", dialOf("--dials", sides[0]), value);
    if (!out.emplace(sides[0], value).second)
      throw SceneError(fmt::format("--dials: {} is given twice", sides[0]));
  }
  if (const std::string fault = heart::contradictionIn(out); !fault.empty())
    throw SceneError("--dials: " + fault);
  return out;
}

namespace {

void refuseUnusable(const ScanOptions& o) {
  double count = 1;
  for (const ScanAxis& axis : o.axes) {
    count *= std::floor((axis.range.high - axis.range.low) / axis.step + 1e-6) + 1;
    if (o.dials.contains(axis.range.key))
      throw SceneError(fmt::format("--dials: {} is scanned; leave it out", axis.range.key));
  }
  if (count > static_cast<double>(kMostUnasked) && !o.yes)
    throw SceneError(
        fmt::format("--scan: {:.0f} evaluations are more than {}: give --yes, or use larger steps",
                    count, kMostUnasked));
  constexpr double kMost = 1e5;
  if (count > kMost)
    throw SceneError(
        fmt::format("--scan: {:.0f} evaluations, accepted: {:g}; use larger steps", count, kMost));
}

// Report on the best heart, recorded at its own dials, with the segments of its wall.
FitReport whereBest(const DialScan& scan, const ModelDiscrepancy& discrepancy,
                    const echo::EchoLoop& real) {
  const ScanPoint& best = scan.points[scan.best];
  std::map<std::string, double> dials = scan.options.dials;
  for (std::size_t a = 0; a < best.values.size(); ++a)
    dials[scan.options.axes[a].range.key] = best.values[a];
  addFollowers(dials);
  const Scene scene =
      heart::heartScene(heart::parametersFrom(dials), scan.options.view, kFitFrames);
  const MeshMotion motion(scene);
  const auto segments = wallSegments(scene, motion);
  return fitReport(scan.tilt
                       ? TiltableModel(scene, motion, kFitFrames, segments).at(scan.tilt->tilt)
                       : modelLoop(scene, motion, kFitFrames, segments),
                   discrepancy, real, best.found.pose);
}

}  // namespace

DialScan scanDials(const ScanOptions& options, const Monitor& monitor) {
  checkTilt(options.tilt_deg);
  refuseUnusable(options);
  DialScan scan;
  scan.options = options;
  scan.view = keyOf(options.view);
  const echo::EchoLoop real = echo::readLoop(options.real, options.side, true);
  std::vector<DialRange> ranges;
  for (const ScanAxis& axis : options.axes) ranges.push_back(axis.range);
  const std::vector<double> middle = middleOf(options.axes);
  double since = cpuSeconds();
  const HeartFamily family(options.dials, ranges, options.view, kFitFrames, nodesFor(ranges.size()),
                           monitor, options.tilt_deg);
  scan.family_ms = 1e3 * (cpuSeconds() - since);
  const ModelLoop first = family.at(middle);
  const ModelDiscrepancy discrepancy(real, options.side, first);
  scan.beat = discrepancy.beat();
  scan.beat_anchor = real.beat_anchor;
  scan.centre = discrepancy.search(first);
  if (options.tilt_deg > 0) {
    scan.tilt = searchTilt([&](const PlaneTilt& tilt) { return family.at(middle, tilt); },
                           discrepancy, scan.centre, options.tilt_deg, monitor);
    scan.centre = scan.tilt->found;
  }
  const PlaneTilt tilt = scan.tilt ? scan.tilt->tilt : PlaneTilt{};
  std::vector<FitPose> starts{scan.centre.pose};
  if (!scan.centre.rivals.empty()) starts.push_back(scan.centre.rivals.front().first);
  since = cpuSeconds();
  static_cast<DialGrid&>(scan) = holdGrid(options.axes, family, discrepancy, starts, tilt, monitor);
  scan.evaluation_ms = 1e3 * (cpuSeconds() - since) / static_cast<double>(scan.points.size());
  scan.where = whereBest(scan, discrepancy, real);
  scan.label = real.label;
  scan.caveats = caveatsOf(real, scan.beat, scan.centre.confidence);
  for (const std::string& note : real.video.notes) scan.notes.push_back(note);
  if (scan.beat.confidence < kLeastConfidence)
    scan.notes.push_back("the start of the beat is ambiguous: give the frame of end-diastole");
  if (scan.centre.at_limit)
    scan.notes.push_back("the pose is at the limit of its search: a better one may lie beyond");
  if (scan.tilt && scan.tilt->at_limit)
    scan.notes.push_back("the tilt is at the limit of its search: a better one may lie beyond");
  for (std::size_t a = 0; a < options.axes.size(); ++a) {
    const std::vector<double> values = options.axes[a].values();
    const double best = scan.points[scan.best].values[a];
    if (best <= values.front() || best >= values.back())
      scan.notes.push_back(fmt::format("the minimum is at the end of {}: extend the scan",
                                       options.axes[a].range.key));
  }
  for (const std::string& note : scan.notes) monitor.warn(note);
  return scan;
}

}  // namespace echocine::fit
