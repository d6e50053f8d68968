#include "scene/probe_pose.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/units.h"

namespace echocine {

namespace {

constexpr int kFewestDigits = 6, kMostDigits = 17;

// The value that a decimal with so many places has when it is read again.
double rounded(double value, int places) {
  return std::strtod(fmt::format("{:.{}f}", value, places).c_str(), nullptr);
}
Vec3d rounded(Vec3d v, int places) {
  return {rounded(v.x, places), rounded(v.y, places), rounded(v.z, places)};
}

bool same(const Pose& a, const Pose& b) {
  return a.origin == b.origin && a.x_axis == b.x_axis && a.y_axis == b.y_axis &&
         a.z_axis == b.z_axis;
}

// The pose that a file with so many decimal places gives.
std::optional<Pose> throughText(const Pose& pose, double mesh_unit_m, int places) {
  return poseOf(mesh_unit_m * rounded(1 / mesh_unit_m * pose.origin, places),
                rounded(pose.z_axis, places), rounded(pose.x_axis, places));
}

int placesOf(const Pose& pose, double mesh_unit_m) {
  for (int places = kFewestDigits; places < kMostDigits; ++places)
    if (const auto read = throughText(pose, mesh_unit_m, places); read && same(*read, pose))
      return places;
  return kMostDigits;
}

// The fewest digits that give a number back through the unit of its key.
std::string shortest(double value, double unit) {
  for (int digits = kFewestDigits; digits < kMostDigits; ++digits) {
    const std::string text = fmt::format("{:.{}g}", value / unit, digits);
    if (std::strtod(text.c_str(), nullptr) * unit == value) return text;
  }
  return fmt::format("{:.17g}", value / unit);
}

// Without trailing zeros.
std::string decimal(double value, int places) {
  std::string text = fmt::format("{:.{}f}", value, places);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string vectorText(Vec3d v, int places) {
  return fmt::format("[{}, {}, {}]", decimal(v.x, places), decimal(v.y, places),
                     decimal(v.z, places));
}

// A power of two brings it near 1 first, exactly: the squares of 1e200 and of 1e-200 are no numbers
// to divide by.
Vec3d unitOf(Vec3d v) {
  const int exponent = -std::ilogb(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}));
  return normalised(
      Vec3d{std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)});
}

}  // namespace

std::optional<Pose> poseOf(Vec3d apex_m, Vec3d axis, Vec3d lateral) {
  Pose pose;
  pose.origin = apex_m;
  pose.z_axis = unitOf(axis);
  const Vec3d aside = unitOf(lateral);
  const Vec3d across = aside - dot(aside, pose.z_axis) * pose.z_axis;
  if (length(across) < 1e-6) return std::nullopt;
  pose.x_axis = normalised(across);
  pose.y_axis = cross(pose.z_axis, pose.x_axis);
  return pose;
}

double defaultFocus(double depth_m) {
  return metresFromMillimetres(millimetresFromMetres(depth_m) / 2);
}

// A text's pose, written again, is mostly the same text; where rounding moves it, it settles.
Pose writable(const Pose& pose, double mesh_unit_m) {
  Pose now = pose;
  for (int step = 0; step < 50; ++step) {
    const auto next = throughText(now, mesh_unit_m, kFewestDigits + 1);
    if (!next || same(*next, now)) break;
    now = *next;
  }
  return now;
}

double writableDepth(double depth_m) {
  return metresFromMillimetres(rounded(millimetresFromMetres(depth_m), 1));
}

std::string poseToml(const Scene& scene) {
  const Probe& probe = scene.probe;
  const double unit = scene.motion.mesh_unit_m;
  const int places = placesOf(probe.pose, unit);
  std::string text = fmt::format(
      "apex = {}\naxis = {}\nlateral = {}\n", vectorText(1 / unit * probe.pose.origin, places),
      vectorText(probe.pose.z_axis, places), vectorText(probe.pose.x_axis, places));
  if (probe.isFan())
    text += fmt::format("sector_deg = {}\n", shortest(probe.last_angle_rad - probe.first_angle_rad,
                                                      radiansFromDegrees(1)));
  return text + fmt::format("depth_mm = {}\nfrequency_mhz = {}\n",
                            shortest(probe.max_depth_m, metresFromMillimetres(1)),
                            shortest(probe.frequency_hz, hertzFromMegahertz(1)));
}

}  // namespace echocine
