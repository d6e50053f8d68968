#include "scene/probe_reader.h"

#include <fmt/format.h>

#include <numbers>

#include "core/units.h"
#include "scene/key_reader.h"
#include "scene/limits.h"
#include "scene/probe_pose.h"
#include "scene/ranges.h"
#include "scene/view_names.h"

namespace echocine {

namespace {

constexpr int kLeastLinesOfTurn = 16;  // so that a cell is far less than a right angle. Our choice

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
    table.unused("shift_mm", "view");
    return std::nullopt;
  }
  ViewPlacement placement;
  placement.view = readViewName(table);
  for (const char* key : {"apex", "axis", "lateral"})
    if (table.has(key))
      table.fail(key,
                 fmt::format("contradicts view = \"{}\", which computes the pose: omit view, or "
                             "apex, axis and lateral; shift_mm, tilt_deg and rotate_deg modify it",
                             keyOf(placement.view)));
  if (table.has("shift_mm"))
    placement.shift_m = metresFromMillimetres(1) * table.vector("shift_mm", ranges::kMostShift_mm);
  placement.place = table.place("view");
  return placement;
}

}  // namespace

void readProbe(TomlTable table, Scene& scene) {
  Probe& probe = scene.probe;
  scene.view = readView(table);
  if (!scene.view) probe.pose = readPose(table, scene.motion.mesh_unit_m);
  readKeys(table, "probe", {&scene});
  if (probe.isFullTurn()) {
    probe.first_angle_rad = -std::numbers::pi;
    probe.last_angle_rad = std::numbers::pi;
    if (probe.lines < kLeastLinesOfTurn)
      table.fail("lines", fmt::format("is {}, accepted for kind = \"radial\": {} and more",
                                      probe.lines, kLeastLinesOfTurn));
  }
  // A view finds the depth where none is given; 0 until then.
  if (probe.max_depth_m <= probe.min_depth_m && !(scene.view && probe.max_depth_m == 0))
    table.fail("depth_mm", fmt::format("is not over min_depth_mm = {}",
                                       millimetresFromMetres(probe.min_depth_m)));
  if (!table.has("focus_mm")) probe.focus_m = defaultFocus(probe.max_depth_m);
  if (static_cast<double>(probe.lines) * probe.samples > kMaxPolarSamples)
    table.fail("samples",
               fmt::format("lines x samples is {}, accepted: up to {}",
                           static_cast<double>(probe.lines) * probe.samples, kMaxPolarSamples));
  table.finish();
}

}  // namespace echocine
