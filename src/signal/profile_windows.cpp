#include "signal/profile_windows.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <tuple>

#include "core/lanes.h"
#include "core/parallel.h"
#include "core/recent_values.h"
#include "scene/sampled_beam.h"
#include "scene/scan_geometry.h"

namespace echocine {

namespace {

// Length of a zone over its depth, in which widths change by as much. Our choice.
constexpr double kZone = 0.025;
// A group is so many angles of the first null, lambda / D, wide, unless there would be more than so
// many. Its weight is exact for an even group; of a bright point, side lobes blur. Our choices.
constexpr double kGroup = 1.5;
constexpr int kMostGroups = 128, kMostRows = 512;
constexpr double kRightAngle = std::numbers::pi / 2;

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

// The directions in which each line's aperture sees the borders between lines. Lines that leave one
// point are steered from an array across the probe's axis; others leave their face at right angles.
class Directions {
 public:
  explicit Directions(const Probe& probe)
      : steered_(probe.isFan() && probe.face_radius_m == 0),
        step_rad_((probe.last_angle_rad - probe.first_angle_rad) / std::max(probe.lines - 1, 1)) {
    for (int i = 0; i < probe.lines; ++i) lines_.push_back(lineGeometry(probe, i));
    if (steered_) seeFrom(0, 1);
  }

  // Sine of a line's direction, from the normal of its aperture.
  double steering(int line) const { return dot(of(line).direction, along(line)); }

  // Sines of the directions to all borders, less the beam's: the one before each line, and the one
  // behind the last.
  std::span<const double> borders(int line, double path_m) {
    if (!steered_) seeFrom(line, path_m);
    borders_.clear();
    const double own = steering(line);
    for (std::size_t i = 0; i <= seen_.size(); ++i) {
      const std::size_t first = std::clamp<std::size_t>(i, 1, seen_.size() - 1) - 1;
      const double behind = static_cast<double>(i) - 0.5 - static_cast<double>(first);
      borders_.push_back(seen_[first] + behind * (seen_[first + 1] - seen_[first]) - own);
    }
    return borders_;
  }

 private:
  const LineGeometry& of(int line) const { return lines_[static_cast<std::size_t>(line)]; }
  Vec3d along(int line) const {
    const Vec3d d = of(line).direction;
    return steered_ ? Vec3d{1, 0, 0} : Vec3d{d.z, 0, -d.x};
  }
  void seeFrom(int line, double path_m) {
    seen_.clear();
    for (std::size_t i = 0; i < lines_.size(); ++i) {
      const LineGeometry& other = lines_[i];
      const Vec3d to = other.origin + path_m * other.direction - of(line).origin;
      const double distance_m = length(to);
      double sine = distance_m > 0 ? dot(to, along(line)) / distance_m : 0;
      // Behind the aperture the sine would fall again, and rise again a turn farther.
      const double apart_rad = (static_cast<double>(i) - line) * step_rad_;
      if (!steered_ && (std::abs(apart_rad) > kRightAngle || dot(to, of(line).direction) < 0))
        sine = apart_rad < 0 ? -1 : 1;
      seen_.push_back(sine);
    }
  }

  std::vector<LineGeometry> lines_;
  bool steered_;
  double step_rad_;                     // from line to line
  std::vector<double> seen_, borders_;  // the sines of lines, and of borders
};

class WindowBuilder {
 public:
  WindowBuilder(const ProfileWindows& all, ProfileWindows::Part& part, const Probe& rows,
                const BeamPulse& pulse, const SampledBeam& beam)
      : all_(all),
        part_(part),
        probe_(rows),
        pulse_(pulse),
        geometry_(rows),
        directions_(rows),
        beam_(beam) {}

  void addZone(const ProfileWindows::Zone& zone) {
    const double path_m =
        0.5 * (geometry_.sampleDepth(zone.first) + geometry_.sampleDepth(zone.last - 1));
    // P depends on u k_f and q k_f, so a lower frequency scales both.
    frequency_ = downshiftOf(probe_, pulse_.cycles, pulse_.downshift_np_per_m_hz, path_m);
    // The receiving aperture scales u alone: near the face the sent beam is even and wide.
    scale_ = frequency_ * receivingPart(probe_, pulse_.receive_f_number, path_m);
    for (int row = 0; row < all_.rows; ++row) addWindow(row, path_m);
  }

 private:
  void addWindow(int row, double path_m) {
    const SampledBeam::Profile profile =
        beam_.at(frequency_ * beam_.defocus(path_m, directions_.steering(row)));
    const int group = all_.in_group, rows = all_.rows;
    const std::span<const double> borders = directions_.borders(row, path_m);
    const auto border = [&](int before) { return borders[static_cast<std::size_t>(before)]; };
    int first = row / group * group, end = std::min(first + group, rows);
    while (first > 0 && scale_ * border(first) > -profile.mainLobe()) first -= group;
    while (end < rows && scale_ * border(end) < profile.mainLobe())
      end = std::min(end + group, rows);
    part_.windows.push_back({first, end, part_.weights.size()});
    weights_.clear();
    at_ = border(0);
    before_ = profile.integral(scale_ * at_);
    for (int i = group; i <= first; i += group) addUntil(border(i), profile);
    for (int i = first + 1; i <= end; ++i) addUntil(border(i), profile);
    for (int i = end; i < rows; i += group) addUntil(border(std::min(i + group, rows)), profile);
    double sum = 0;
    for (const double weight : weights_) sum += weight;
    // Lines too near to one another for the table: each stands for itself.
    if (!(sum > 0)) sum = weights_[static_cast<std::size_t>(first / group + row - first)] = 1;
    for (const double weight : weights_) part_.weights.push_back(static_cast<float>(weight / sum));
  }

  // Beyond a right angle there is no more of the integral; such lines weigh nothing.
  void addUntil(double u, const SampledBeam::Profile& profile) {
    at_ = std::max(at_, u);
    const double until = profile.integral(scale_ * at_);
    weights_.push_back(std::max(until - before_, 0.0));  // rounding may leave less
    before_ = until;
  }

  const ProfileWindows& all_;
  ProfileWindows::Part& part_;
  const Probe& probe_;
  const BeamPulse& pulse_;
  // At the depth of a zone: centre frequency over that of the pulse, and the factor of u.
  double frequency_ = 1, scale_ = 1;
  ScanGeometry geometry_;
  Directions directions_;
  const SampledBeam& beam_;
  std::vector<double> weights_;  // of a window
  double at_ = 0, before_ = 0;   // its last border, and the integral until there
};

}  // namespace

ProfileWindows::ProfileWindows(const Probe& probe, const BeamPulse& pulse)
    : in_row(atLeast(probe.lines, kMostRows)) {
  const Probe probe_of_rows = probeOfRows(probe, in_row);
  const ScanGeometry geometry(probe_of_rows);
  rows = probe_of_rows.lines;
  const double in_null = geometry.linesAcross(geometry.wavelength() / probe.aperture_m);
  in_group = static_cast<int>(
      std::clamp(kGroup * in_null, double{1} * atLeast(rows, kMostGroups), double{1} * rows));
  groups = atLeast(rows, in_group);
  const int lanes = kFloatLanes;
  for (int first = 0, last = 0; first < probe.samples; first = last) {
    const double samples = kZone * geometry.sampleDepth(first) / probe.sampleSpacing();
    last = std::min(first + std::max(static_cast<int>(samples) / lanes, 1) * lanes, probe.samples);
    zones.push_back({first, last, 0});
  }
  fill(probe_of_rows, pulse);
}

void ProfileWindows::fill(const Probe& probe_of_rows, const BeamPulse& pulse) {
  constexpr std::size_t kZonesTogether = 16;  // zones. Our choice
  const SampledBeam beam(probe_of_rows, pulse.cycles, pulse.harmonic);
  std::vector<Part> parts((zones.size() + kZonesTogether - 1) / kZonesTogether);
  parallelBlocks(zones.size(), kZonesTogether, [&](std::size_t begin, std::size_t end) {
    WindowBuilder builder(*this, parts[begin / kZonesTogether], probe_of_rows, pulse, beam);
    for (std::size_t z = begin; z < end; ++z) builder.addZone(zones[z]);
  });
  for (std::size_t z = 0; z < zones.size(); ++z)
    zones[z].windows = z * static_cast<std::size_t>(rows);
  for (Part& part : parts) {
    for (Window window : part.windows) {
      window.weights += weights.size();
      windows.push_back(window);
    }
    weights.insert(weights.end(), part.weights.begin(), part.weights.end());
    part = {};
  }
}

namespace {

// All of a probe that windows depend on: not its pose or its lens. A new member of Probe does not
// compile until it stands here.
auto keyOf(const Probe& probe, const BeamPulse& pulse) {
  const auto& [kind, pose, first_angle, last_angle, face_radius, first_offset, last_offset,
               min_depth, max_depth, frequency, aperture, focus, apodization, bandwidth,
               elevation_aperture, elevation_focus, line_count, sample_count] = probe;
  return std::tuple(kind, first_angle, last_angle, face_radius, first_offset, last_offset,
                    min_depth, max_depth, frequency, aperture, focus, apodization, bandwidth,
                    line_count, sample_count, pulse.cycles, pulse.harmonic,
                    pulse.downshift_np_per_m_hz, pulse.receive_f_number);
}

}  // namespace

// Windows of 256 lines by 1024 samples are some megabytes. Our choice: a run has one or two probes.
std::shared_ptr<const ProfileWindows> sharedProfileWindows(const Probe& probe,
                                                           const BeamPulse& pulse) {
  constexpr std::size_t kMostKept = 2;
  static RecentValues<decltype(keyOf(probe, pulse)), ProfileWindows> recent(kMostKept);
  return recent.get(keyOf(probe, pulse), [&] { return ProfileWindows(probe, pulse); });
}

const ProfileWindows::Zone& ProfileWindows::zoneOf(int sample) const {
  return *std::upper_bound(zones.begin(), zones.end(), sample,
                           [](int at, const Zone& zone) { return at < zone.last; });
}

}  // namespace echocine
