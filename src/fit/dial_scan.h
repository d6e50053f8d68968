#pragma once
// The discrepancy over a heart's dials: sharpness of its minimum, smoothness, and correlated dials.

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "fit/dial_grid.h"
#include "fit/fit_report.h"

namespace echocine::fit {

// "ef=0.3:0.75:0.05,edv=120:230:20". Throws SceneError naming --scan for an unknown dial, values
// out of range, a step that is not positive, or more than three dials.
std::vector<ScanAxis> parseScan(const std::string& text);
// "hr=72,wall-thickness=11". Throws SceneError naming --dials.
std::map<std::string, double> parseDials(const std::string& text);

struct ScanOptions {
  std::filesystem::path real;
  echo::SideOptions side;
  std::vector<ScanAxis> axes;
  std::map<std::string, double> dials;  // fixed dials; other dials follow them
  heart::View view = heart::View::a4c;
  double tilt_deg = 0;  // limit of tilt and rotation of the plane, either way
  bool yes = false;     // more than kMostUnasked evaluations
};
inline constexpr std::size_t kMostUnasked = 500;  // some two minutes of one core; our choice

struct DialScan : DialGrid {
  ScanOptions options;
  std::string view;
  BeatFound beat;
  std::string beat_anchor;        // of the loop: EchoLoop::beat_anchor
  PoseFound centre;               // at the centre of all ranges, searched globally
  std::optional<TiltFound> tilt;  // of that heart, if requested; used for all points
  double family_ms = 0,
         evaluation_ms = 0;          // CPU time: of computing the family, mean of one evaluation
  std::vector<std::string> caveats;  // caveats.h
  std::vector<std::string> notes;
  std::string label;  // of the loop: EchoLoop::label
  FitReport where;    // of the best point
};

// Throws SceneError and JobError like compareLoops(), and for more than kMostUnasked evaluations
// without `yes`.
DialScan scanDials(const ScanOptions& options, const Monitor& monitor = {});

// scan.csv, scan.json and scan.html. Throws JobError.
void writeScan(const DialScan& scan, const std::filesystem::path& folder);

}  // namespace echocine::fit
