#include "scene/probe.h"

#include <cmath>

namespace echocine {

namespace {

double lineFraction(const Probe& probe, int line) {
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
  const double angle = (probe.last_angle_rad - probe.first_angle_rad) / (probe.lines - 1);
  const double offset = (probe.last_offset_m - probe.first_offset_m) / (probe.lines - 1);
  return angle * (probe.face_radius_m + depth_m) + offset;
}

}  // namespace echocine
