#include "signal/profile_windows.h"

#include <algorithm>

#include "core/lanes.h"
#include "scene/sampled_beam.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// Length of a zone over its depth, in which widths change by as much. Our choice.
constexpr double kZone = 0.025;
// A group is this part of the first null's angle, lambda / D, unless there would be more than so
// many. Our choices.
constexpr double kGroup = 0.5;
constexpr int kMostGroups = 128, kMostRows = 512;

// The least whole number of parts.
int atLeast(int count, int part) {
  return (count + part - 1) / part;
}

// A probe whose lines are the middles of rows of lines.
Probe probeOfRows(const Probe& probe, int in_row) {
  Probe rows = probe;
  rows.lines = atLeast(probe.lines, in_row);
  const double first = 0.5 * (in_row - 1), last = first + double{1} * in_row * (rows.lines - 1);
  const auto move = [&](double& from, double& to) {
    const double step = (to - from) / (probe.lines - 1), start = from;
    from = start + first * step;
    to = start + last * step;
  };
  move(rows.first_angle_rad, rows.last_angle_rad);
  move(rows.first_offset_m, rows.last_offset_m);
  return rows;
}

// The directions in which each line's aperture sees the others. Lines that leave one point are
// steered from an array across the probe's axis; others leave their face at right angles.
class Directions {
 public:
  explicit Directions(const Probe& probe) : steered_(probe.isFan() && probe.face_radius_m == 0) {
    for (int i = 0; i < probe.lines; ++i) lines_.push_back(lineGeometry(probe, i));
  }

  int lines() const { return static_cast<int>(lines_.size()); }
  // Sine of a line's direction, from the normal of its aperture.
  double steering(int line) const { return dot(of(line).direction, along(line)); }

  // Sine of the direction to the border before a line, less the beam's; `lines` has the border
  // behind the last one.
  double border(int line, int before, double path_m) const {
    const int first = std::clamp(before - 1, 0, lines() - 2);
    const double at_first = seen(line, first, path_m), at_next = seen(line, first + 1, path_m);
    return at_first + (before - 0.5 - first) * (at_next - at_first) - steering(line);
  }

 private:
  const LineGeometry& of(int line) const { return lines_[static_cast<std::size_t>(line)]; }
  Vec3d along(int line) const {
    const Vec3d d = of(line).direction;
    return steered_ ? Vec3d{1, 0, 0} : Vec3d{d.z, 0, -d.x};
  }
  double seen(int line, int other, double path_m) const {
    const Vec3d to = of(other).origin + path_m * of(other).direction - of(line).origin;
    const double distance_m = length(to);
    return distance_m > 0 ? dot(to, along(line)) / distance_m : 0;
  }

  std::vector<LineGeometry> lines_;
  bool steered_;
};

class WindowBuilder {
 public:
  WindowBuilder(ProfileWindows& all, const Probe& rows, double pulse_cycles)
      : all_(all), geometry_(rows), directions_(rows), beam_(rows, pulse_cycles) {}

  void addZone(int first, int last) {
    all_.zones.push_back({first, last, all_.windows.size()});
    const double path_m = 0.5 * (geometry_.sampleDepth(first) + geometry_.sampleDepth(last - 1));
    for (int row = 0; row < all_.rows; ++row) addWindow(row, path_m);
  }

 private:
  void addWindow(int row, double path_m) {
    const SampledBeam::Profile profile = beam_.at(beam_.defocus(path_m, directions_.steering(row)));
    const int group = all_.in_group, rows = all_.rows;
    const auto border = [&](int before) { return directions_.border(row, before, path_m); };
    int first = row / group * group, end = std::min(first + group, rows);
    while (first > 0 && border(first) > -profile.mainLobe()) first -= group;
    while (end < rows && border(end) < profile.mainLobe()) end = std::min(end + group, rows);
    all_.windows.push_back({first, end, all_.weights.size()});
    weights_.clear();
    at_ = border(0);
    before_ = profile.integral(at_);
    for (int i = group; i <= first; i += group) addUntil(border(i), profile);
    for (int i = first + 1; i <= end; ++i) addUntil(border(i), profile);
    for (int i = end; i < rows; i += group) addUntil(border(std::min(i + group, rows)), profile);
    double sum = 0;
    for (const double weight : weights_) sum += weight;
    for (const double weight : weights_) all_.weights.push_back(static_cast<float>(weight / sum));
  }

  // Beyond a right angle the sine falls again; such lines weigh nothing.
  void addUntil(double u, const SampledBeam::Profile& profile) {
    at_ = std::max(at_, u);
    const double until = profile.integral(at_);
    weights_.push_back(until - before_);
    before_ = until;
  }

  ProfileWindows& all_;
  ScanGeometry geometry_;
  Directions directions_;
  SampledBeam beam_;
  std::vector<double> weights_;  // of a window
  double at_ = 0, before_ = 0;   // its last border, and the integral until there
};

}  // namespace

ProfileWindows::ProfileWindows(const Probe& probe, double pulse_cycles)
    : in_row(atLeast(probe.lines, kMostRows)) {
  const Probe probe_of_rows = probeOfRows(probe, in_row);
  const ScanGeometry geometry(probe_of_rows);
  rows = probe_of_rows.lines;
  const double in_null = geometry.linesAcross(geometry.wavelength() / probe.aperture_m);
  in_group = static_cast<int>(
      std::clamp(kGroup * in_null, double{1} * atLeast(rows, kMostGroups), double{1} * rows));
  groups = atLeast(rows, in_group);
  WindowBuilder builder(*this, probe_of_rows, pulse_cycles);
  const int lanes = kFloatLanes;
  for (int first = 0, last = 0; first < probe.samples; first = last) {
    const double samples = kZone * geometry.sampleDepth(first) / probe.sampleSpacing();
    last = std::min(first + std::max(static_cast<int>(samples) / lanes, 1) * lanes, probe.samples);
    builder.addZone(first, last);
  }
}

}  // namespace echocine
