#pragma once
// The discrepancy over a heart's dials: how sharp its minimum is, how smooth, which dials stand in
// for one another.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fit/dial_grid.h"
#include "fit/fit_report.h"

namespace echocine::fit {

// "ef=0.3:0.75:0.05,edv=120:230:20". Throws SceneError naming --scan: no dial of the heart, beyond
// its range, no step upwards, more than three dials.
std::vector<ScanAxis> parseScan(const std::string& text);
// "hr=72,wall-thickness=11". Throws SceneError naming --dials.
std::map<std::string, double> parseDials(const std::string& text);

struct ScanOptions {
  std::filesystem::path real;
  echo::SideOptions side;
  std::vector<ScanAxis> axes;
  std::map<std::string, double> dials;  // that stay; the rest follows them
  heart::View view = heart::View::a4c;
  double tilt_deg = 0;  // by which the plane may be tilted and rotated, either way
  bool yes = false;     // more than kMostUnasked evaluations
};
inline constexpr std::size_t kMostUnasked = 500;  // some two minutes of one core; our choice

struct DialScan : DialGrid {
  ScanOptions options;
  std::string view;
  BeatFound beat;
  std::string beat_anchor;                  // of the loop: EchoLoop::beat_anchor
  PoseFound centre;                         // in the middle of all ranges, searched from everywhere
  std::optional<TiltFound> tilt;            // of that heart, where asked for; all points have it
  double family_ms = 0, evaluation_ms = 0;  // CPU time: of recording, of one evaluation in the mean
  std::vector<std::string> notes;
  FitReport where;  // of the best point
};

// Throws SceneError and JobError as compareLoops() does, and where too many evaluations are asked
// for.
DialScan scanDials(const ScanOptions& options, const Monitor& monitor = {});

// scan.csv, scan.json and scan.html. Throws JobError.
void writeScan(const DialScan& scan, const std::filesystem::path& folder);

}  // namespace echocine::fit
