#include "scene/probe_reader.h"

#include <fmt/format.h>

#include "core/units.h"
#include "scene/limits.h"
#include "scene/probe_pose.h"
#include "scene/ranges.h"
#include "scene/view_names.h"

namespace echocine {

namespace {

Vec3d readDirection(TomlTable& table, std::string_view key) {
  const Vec3d v = table.vector(key);
  if (v == Vec3d{}) table.fail(key, "is the zero vector, accepted: a direction");
  return v;
}

Pose readPose(TomlTable& table, double mesh_unit_m) {
  if (!table.has("apex") && !table.has("axis") && !table.has("lateral"))
    table.fail("apex",
               "is needed with axis and lateral, accepted: three numbers [x, y, z] each; or a view "
               "found from structures with roles: view = \"a4c\"");
  const Vec3d axis = readDirection(table, "axis"), lateral = readDirection(table, "lateral");
  const Vec3d apex_m = mesh_unit_m * table.vector("apex", ranges::kMostCoordinate);
  const std::optional<Pose> pose = poseOf(apex_m, axis, lateral);
  if (!pose) table.fail("lateral", "is parallel to axis, accepted: a direction across it");
  return *pose;
}

View readViewName(TomlTable& table) {
  const std::string key = table.text("view");
  const std::optional<View> view = viewOf(key);
  if (view) return *view;
  std::string accepted;
  for (const ViewName& name : viewNames())
    accepted += fmt::format("{}\"{}\"", accepted.empty() ? "" : ", ", name.key);
  table.fail("view", fmt::format("is \"{}\", accepted: {}", key, accepted));
}

// Where the pose is found from the meshes, and what is changed about it.
std::optional<ViewPlacement> readView(TomlTable& table) {
  if (!table.has("view")) {
    for (const char* key : {"shift_mm", "tilt_deg", "rotate_deg"}) table.unused(key, "view");
    return std::nullopt;
  }
  ViewPlacement placement;
  placement.view = readViewName(table);
  for (const char* key : {"apex", "axis", "lateral"})
    if (table.has(key))
      table.fail(key, fmt::format("contradicts view = \"{}\", which finds the pose: leave out view, "
                                  "or apex, axis and lateral; shift_mm, tilt_deg and rotate_deg "
                                  "change what is found",
                                  keyOf(placement.view)));
  if (table.has("shift_mm"))
    placement.shift_m = metresFromMillimetres(1) * table.vector("shift_mm", ranges::kMostShift_mm);
  placement.tilt_rad = radiansFromDegrees(table.number("tilt_deg", 0.0, ranges::kTilt_deg));
  placement.rotate_rad = radiansFromDegrees(table.number("rotate_deg", 0.0, ranges::kRotate_deg));
  placement.place = table.place("view");
  return placement;
}

// Of an adult cardiac probe, where the view places it. Our choice.
std::optional<double> viewDefault(bool view, double value) {
  return view ? std::optional(value) : std::nullopt;
}

void readFootprint(TomlTable& table, bool view, Probe& probe) {
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
      radiansFromDegrees(table.number("sector_deg", viewDefault(view, 80), ranges::kSector_deg));
  probe.first_angle_rad = -sector / 2;
  probe.last_angle_rad = sector / 2;
  if (probe.kind == ProbeKind::curvilinear)
    probe.face_radius_m =
        metresFromMillimetres(table.number("face_radius_mm", std::nullopt, ranges::kRadius_mm));
}

}  // namespace

Probe readProbe(TomlTable table, double mesh_unit_m, std::optional<ViewPlacement>& view) {
  Probe probe;
  probe.kind = table.choice("kind", ProbeKind::phased);
  view = readView(table);
  if (!view) probe.pose = readPose(table, mesh_unit_m);
  readFootprint(table, view.has_value(), probe);
  probe.min_depth_m = metresFromMillimetres(table.number("min_depth_mm", 2.0, ranges::kNearEnd_mm));
  const bool depth_found = view && !table.has("depth_mm");
  if (!depth_found)
    probe.max_depth_m =
        metresFromMillimetres(table.number("depth_mm", std::nullopt, ranges::kExtent_mm));
  if (!depth_found && probe.max_depth_m <= probe.min_depth_m)
    table.fail("depth_mm", fmt::format("is not over min_depth_mm = {}",
                                       millimetresFromMetres(probe.min_depth_m)));
  probe.frequency_hz = hertzFromMegahertz(table.number(
      "frequency_mhz", viewDefault(view.has_value(), 2.5), {.lo = 0.1, .hi = 100}));
  // Choices of ours: the 20 mm footprint of an adult cardiac probe, focused at half the depth.
  probe.aperture_m = metresFromMillimetres(table.number("aperture_mm", 20.0, ranges::kExtent_mm));
  probe.focus_m = defaultFocus(probe.max_depth_m);  // 0: of a depth that is still to be found
  if (table.has("focus_mm"))
    probe.focus_m = metresFromMillimetres(table.number("focus_mm", 0.0, ranges::kRadius_mm));
  probe.elevation_aperture_m = metresFromMillimetres(
      table.number("elevation_aperture_mm", millimetresFromMetres(probe.elevation_aperture_m),
                   ranges::kExtent_mm));
  probe.elevation_focus_m = metresFromMillimetres(table.number(
      "elevation_focus_mm", millimetresFromMetres(probe.elevation_focus_m), ranges::kRadius_mm));
  probe.lines = table.integer("lines", 256, 1, ranges::kMostLines);
  probe.samples = table.integer("samples", 1024, 1, 65536);
  if (static_cast<double>(probe.lines) * probe.samples > kMaxPolarSamples)
    table.fail("samples",
               fmt::format("lines x samples is {}, accepted: up to {}",
                           static_cast<double>(probe.lines) * probe.samples, kMaxPolarSamples));
  table.finish();
  return probe;
}

}  // namespace echocine
