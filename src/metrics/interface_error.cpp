#include "metrics/interface_error.h"
#include "scene/scan_geometry.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace echocine {

namespace {

constexpr double kGate_m = 5e-3;

// Position of a line of one probe among the lines of another that scans the same sector.
double samePlace(int line, const Probe& from, const Probe& to) {
  if (from.isFullTurn()) return (line + 0.5) / from.lines * to.lines - 0.5;
  const double t = from.lines > 1 ? static_cast<double>(line) / (from.lines - 1) : 0.5;
  return t * (to.lines - 1);
}

double sampleCentre(const Probe& probe, double depth_m) {
  const double k = std::floor((depth_m - probe.min_depth_m) / probe.sampleSpacing());
  return probe.min_depth_m +
         (std::clamp(k, 0.0, probe.samples - 1.0) + 0.5) * probe.sampleSpacing();
}

Vec3d pointAt(const Probe& probe, int line, double depth_m) {
  const LineGeometry geometry = lineGeometry(probe, line);
  return geometry.origin + depth_m * geometry.direction;
}

// Where the setting draws the interface on one of its lines.
std::optional<Vec3d> drawn(const InterfaceMap& map, int line, const InterfacePlace& wanted) {
  const InterfacePlace* best = nullptr;
  for (const InterfacePlace& p : map.lines[static_cast<std::size_t>(line)])
    if (p.surface == wanted.surface && p.entering == wanted.entering &&
        (best == nullptr ||
         std::abs(p.depth_m - wanted.depth_m) < std::abs(best->depth_m - wanted.depth_m)))
      best = &p;
  if (best == nullptr) return std::nullopt;
  return pointAt(map.probe, line, sampleCentre(map.probe, best->depth_m));
}

double distanceToEdge(Vec3d point, Vec3d a, Vec3d b) {
  const Vec3d along = b - a;
  const double squared = dot(along, along);
  const double t = squared > 0 ? std::clamp(dot(point - a, along) / squared, 0.0, 1.0) : 0;
  return length(point - (a + t * along));
}

}  // namespace

InterfaceMap interfaceMap(const Probe& probe, const std::vector<LineTrace>& traces) {
  InterfaceMap map{probe, std::vector<std::vector<InterfacePlace>>(traces.size())};
  for (std::size_t i = 0; i < traces.size(); ++i)
    for (const InterfaceHit& pass : traces[i].hits)
      if (pass.seen && pass.depth_m >= probe.min_depth_m && pass.depth_m < probe.max_depth_m)
        map.lines[i].push_back({pass.surface, pass.entering, pass.depth_m});
  return map;
}

void InterfaceError::add(const InterfaceMap& setting, const InterfaceMap& reference) {
  const ScanGeometry scanned(setting.probe);
  for (std::size_t i = 0; i < reference.lines.size(); ++i) {
    const int line = static_cast<int>(i);
    const double place = samePlace(line, reference.probe, setting.probe);
    const double before = std::floor(place);
    const int left = scanned.nearestLine(before), right = scanned.nearestLine(before + 1);
    for (const InterfacePlace& p : reference.lines[i]) {
      const Vec3d truth = pointAt(reference.probe, line, p.depth_m);
      const std::optional<Vec3d> a = drawn(setting, left, p);
      // A line of the setting at the very angle draws the interface alone.
      const std::optional<Vec3d> b = place > before ? drawn(setting, right, p) : a;
      if (!a && !b) {
        ++missed_;
        continue;
      }
      const double error = distanceToEdge(truth, a ? *a : *b, b ? *b : *a);
      if (error > kGate_m)
        ++missed_;
      else
        errors_m_.push_back(error);
    }
  }
}

double InterfaceError::rms_m() const {
  double squares = 0;
  for (const double e : errors_m_) squares += e * e;
  return errors_m_.empty() ? 0 : std::sqrt(squares / static_cast<double>(errors_m_.size()));
}

double InterfaceError::percentile95_m() const {
  if (errors_m_.empty()) return 0;
  std::vector<double> sorted = errors_m_;
  std::sort(sorted.begin(), sorted.end());
  const double rank = std::ceil(0.95 * static_cast<double>(sorted.size()));
  return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
}

double InterfaceError::missedShare() const {
  const std::size_t all = errors_m_.size() + missed_;
  return all == 0 ? 0 : static_cast<double>(missed_) / static_cast<double>(all);
}

}  // namespace echocine
