#include "scene/scan_geometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace echocine {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

double lineFraction(const Probe& probe, int line) {
  if (probe.isFullTurn()) return (line + 0.5) / probe.lines;
  return probe.lines > 1 ? static_cast<double>(line) / (probe.lines - 1) : 0.5;
}

}  // namespace

LineGeometry lineGeometry(const Probe& probe, int line) {
  const double t = lineFraction(probe, line);
  const double angle = probe.first_angle_rad + t * (probe.last_angle_rad - probe.first_angle_rad);
  const double offset = probe.first_offset_m + t * (probe.last_offset_m - probe.first_offset_m);
  const Vec3d direction{std::sin(angle), 0, std::cos(angle)};
  return {Vec3d{offset, 0, 0} + probe.face_radius_m * direction, direction};
}

double lineSpacing(const Probe& probe, double depth_m) {
  if (probe.lines < 2) return 0;
  if (probe.isFullTurn()) return kTurn / probe.lines * (probe.face_radius_m + depth_m);
  const double angle = (probe.last_angle_rad - probe.first_angle_rad) / (probe.lines - 1);
  const double offset = (probe.last_offset_m - probe.first_offset_m) / (probe.lines - 1);
  return angle * (probe.face_radius_m + depth_m) + offset;
}

bool inScanArea(const Probe& probe, double x_m, double z_m) {
  if (!probe.isFan())
    return x_m >= probe.first_offset_m && x_m <= probe.last_offset_m && z_m >= probe.min_depth_m &&
           z_m <= probe.max_depth_m;
  const double angle = std::atan2(x_m, z_m), path_m = std::hypot(x_m, z_m) - probe.face_radius_m;
  return angle >= probe.first_angle_rad && angle <= probe.last_angle_rad &&
         path_m >= probe.min_depth_m && path_m <= probe.max_depth_m;
}

std::vector<Vec3d> sectorOutline(const Probe& probe) {
  if (!probe.isFan())
    return {{probe.first_offset_m, 0, probe.min_depth_m},
            {probe.last_offset_m, 0, probe.min_depth_m},
            {probe.last_offset_m, 0, probe.max_depth_m},
            {probe.first_offset_m, 0, probe.max_depth_m}};
  constexpr int kArcPoints = 257;
  std::vector<Vec3d> outline;
  if (!probe.isFullTurn()) outline.push_back({0, 0, 0});
  const double radius_m = probe.face_radius_m + probe.max_depth_m;
  for (int i = 0; i < kArcPoints; ++i) {
    const double angle = probe.last_angle_rad +
                         (probe.first_angle_rad - probe.last_angle_rad) * i / (kArcPoints - 1);
    outline.push_back({radius_m * std::sin(angle), 0, radius_m * std::cos(angle)});
  }
  return outline;
}

Box scanBox(const Probe& probe) {
  Probe outline = probe;
  outline.lines = 257;  // odd: the middle line reaches deepest
  Box box;
  for (int i = 0; i < outline.lines; ++i) {
    const LineGeometry line = lineGeometry(outline, i);
    box.add(line.origin + probe.min_depth_m * line.direction);
    box.add(line.origin + probe.max_depth_m * line.direction);
  }
  return box;
}

ScanGeometry::ScanGeometry(const Probe& probe)
    : probe_(probe),
      angular_(probe.isFan()),
      first_place_(angular_ ? probe.first_angle_rad : probe.first_offset_m),
      last_place_(angular_ ? probe.last_angle_rad : probe.last_offset_m) {
  if (!fullTurn()) return;
  first_place_ += cellWidth() / 2;
  last_place_ -= cellWidth() / 2;
}

double ScanGeometry::cellWidth() const {
  if (fullTurn()) return kTurn / probe_.lines;
  return (last_place_ - first_place_) / (probe_.lines - 1);
}

int ScanGeometry::nearestLine(double line) const {
  const int nearest = static_cast<int>(std::lround(line));
  if (fullTurn()) return (nearest % probe_.lines + probe_.lines) % probe_.lines;
  return std::clamp(nearest, 0, probe_.lines - 1);
}

double ScanGeometry::placeOf(Vec3d p) const {
  return angular_ ? std::atan2(p.x, p.z) : p.x;
}

double ScanGeometry::pathOf(Vec3d p) const {
  return angular_ ? length(p) - probe_.face_radius_m : p.z;
}

std::optional<ScanGeometry::BeamPosition> ScanGeometry::at(double place, double path_m) const {
  if (fullTurn()) {
    const double turns = (place - first_place_) / kTurn;
    const double line = (turns - std::floor(turns)) * probe_.lines;
    return BeamPosition{line < probe_.lines ? line : 0, path_m};
  }
  const double t = (place - first_place_) / (last_place_ - first_place_);
  if (!(t >= 0 && t <= 1)) return std::nullopt;
  return BeamPosition{t * (probe_.lines - 1), path_m};
}

std::optional<ScanGeometry::BeamPosition> ScanGeometry::beamPosition(double x_m, double z_m) const {
  return at(placeOf({x_m, 0, z_m}), angular_ ? std::hypot(x_m, z_m) - probe_.face_radius_m : z_m);
}

std::optional<ScanGeometry::BeamPosition> ScanGeometry::beamPositionBeside(Vec3d known_m,
                                                                           double known_place,
                                                                           Vec3d point_m) const {
  if (!angular_) return at(point_m.x, point_m.z);
  // tan(difference of the angles); its arc tangent by five terms of the power series.
  const double cosine = known_m.x * point_m.x + known_m.z * point_m.z;
  const double tangent = (known_m.z * point_m.x - known_m.x * point_m.z) / cosine;
  constexpr double kLargest = 0.1;  // the sixth term is 1e-12
  if (!(cosine > 0 && std::abs(tangent) <= kLargest)) return beamPosition(point_m.x, point_m.z);
  const double square = tangent * tangent;
  const double angle_rad =
      tangent * (1 - square * (1. / 3 - square * (1. / 5 - square * (1. / 7 - square * (1. / 9)))));
  return at(known_place + angle_rad,
            std::sqrt(point_m.x * point_m.x + point_m.z * point_m.z) - probe_.face_radius_m);
}

}  // namespace echocine
