#include "scene/probe_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "scene/limits.h"
#include "scene/ranges.h"

namespace echocine {

namespace {

// A vector of any length but 0 as a unit vector. A power of two brings it near 1 first, exactly:
// the squares of 1e200 and of 1e-200 are no numbers to divide by.
Vec3d readDirection(TomlTable& table, std::string_view key) {
  const Vec3d v = table.vector(key);
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (largest == 0) table.fail(key, "is the zero vector, accepted: a direction");
  const int exponent = -std::ilogb(largest);
  return normalised(
      Vec3d{std::ldexp(v.x, exponent), std::ldexp(v.y, exponent), std::ldexp(v.z, exponent)});
}

// The lateral axis is made perpendicular to the depth axis; the elevation axis completes a
// right-handed frame.
Pose readPose(TomlTable& table, double mesh_unit_m) {
  Pose pose;
  pose.z_axis = readDirection(table, "axis");
  const Vec3d unit_lateral = readDirection(table, "lateral");
  pose.origin = mesh_unit_m * table.vector("apex", ranges::kMostCoordinate);
  const Vec3d across = unit_lateral - dot(unit_lateral, pose.z_axis) * pose.z_axis;
  if (length(across) < 1e-6)
    table.fail("lateral", "is parallel to axis, accepted: a direction across it");
  pose.x_axis = normalised(across);
  pose.y_axis = cross(pose.z_axis, pose.x_axis);
  return pose;
}

void readFootprint(TomlTable& table, Probe& probe) {
  if (probe.kind != ProbeKind::linear) table.unused("width_mm", "kind = \"linear\"");
  if (probe.kind != ProbeKind::curvilinear)
    table.unused("face_radius_mm", "kind = \"curvilinear\"");
  if (probe.kind == ProbeKind::linear) {
    table.unused("sector_deg", "kind = \"phased\" | \"curvilinear\"");
    const double width =
        metresFromMillimetres(table.number("width_mm", std::nullopt, ranges::kExtent_mm));
    probe.first_offset_m = -width / 2;
    probe.last_offset_m = width / 2;
    return;
  }
  const double sector =
      radiansFromDegrees(table.number("sector_deg", std::nullopt, ranges::kSector_deg));
  probe.first_angle_rad = -sector / 2;
  probe.last_angle_rad = sector / 2;
  if (probe.kind == ProbeKind::curvilinear)
    probe.face_radius_m =
        metresFromMillimetres(table.number("face_radius_mm", std::nullopt, ranges::kRadius_mm));
}

}  // namespace

Probe readProbe(TomlTable table, double mesh_unit_m) {
  Probe probe;
  probe.kind = table.choice("kind", ProbeKind::phased);
  probe.pose = readPose(table, mesh_unit_m);
  readFootprint(table, probe);
  probe.min_depth_m = metresFromMillimetres(table.number("min_depth_mm", 2.0, ranges::kNearEnd_mm));
  probe.max_depth_m =
      metresFromMillimetres(table.number("depth_mm", std::nullopt, ranges::kExtent_mm));
  if (probe.max_depth_m <= probe.min_depth_m)
    table.fail("depth_mm", fmt::format("is not over min_depth_mm = {}",
                                       millimetresFromMetres(probe.min_depth_m)));
  probe.frequency_hz =
      hertzFromMegahertz(table.number("frequency_mhz", std::nullopt, {.lo = 0.1, .hi = 100}));
  // Choices of ours: the 20 mm footprint of an adult cardiac probe, focused at half the depth.
  probe.aperture_m = metresFromMillimetres(table.number("aperture_mm", 20.0, ranges::kExtent_mm));
  probe.focus_m = metresFromMillimetres(
      table.number("focus_mm", millimetresFromMetres(probe.max_depth_m) / 2, ranges::kRadius_mm));
  probe.elevation_aperture_m = metresFromMillimetres(
      table.number("elevation_aperture_mm", millimetresFromMetres(probe.elevation_aperture_m),
                   ranges::kExtent_mm));
  probe.elevation_focus_m = metresFromMillimetres(table.number(
      "elevation_focus_mm", millimetresFromMetres(probe.elevation_focus_m), ranges::kRadius_mm));
  probe.lines = table.integer("lines", 256, 1, 65536);
  probe.samples = table.integer("samples", 1024, 1, 65536);
  if (static_cast<double>(probe.lines) * probe.samples > kMaxPolarSamples)
    table.fail("samples",
               fmt::format("lines x samples is {}, accepted: up to {}",
                           static_cast<double>(probe.lines) * probe.samples, kMaxPolarSamples));
  table.finish();
  return probe;
}

}  // namespace echocine
