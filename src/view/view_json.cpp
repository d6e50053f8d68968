#include "view/view_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base64.h"
#include "core/units.h"
#include "scene/names.h"
#include "scene/role.h"
#include "signal/picture.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kSteps = 65535;

// Micrometres are finer than any mesh.
double shownMillimetres(double metres) {
  return std::round(1e3 * millimetresFromMetres(metres)) / 1e3;
}

Json millimetres(Vec3d p_m) {
  return {shownMillimetres(p_m.x), shownMillimetres(p_m.y), shownMillimetres(p_m.z)};
}

Json boxJson(const Box& box_m) {
  return {millimetres(box_m.lo), millimetres(box_m.hi)};
}

void append(std::vector<std::byte>& bytes, std::uint32_t value, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<std::byte>(value >> (8 * i)));
}

Json indicesJson(const DecimatedMesh& mesh) {
  const int size = mesh.vertices.size() > 65536 ? 4 : 2;
  std::vector<std::byte> bytes;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t corner : t) append(bytes, corner, size);
  return base64(bytes);
}

// Where the steps begin and how long one is, mm.
struct Steps {
  Vec3d from_mm, step_mm;
};

Steps stepsOf(const ViewStructure& structure) {
  Box box;
  for (const std::vector<Vec3f>& phase : structure.positions_m)
    for (const Vec3f p : phase) box.add(toDouble(p));
  if (structure.mesh.vertices.empty()) box.add({});
  const Vec3d size_m = box.hi - box.lo;
  return {1e3 * box.lo, (1e3 / kSteps) * size_m};
}

Json positionsJson(const ViewStructure& structure, const Steps& steps) {
  const auto stepOf = [](double mm, double from_mm, double step_mm) {
    const double step = step_mm > 0 ? std::round((mm - from_mm) / step_mm) : 0;
    return static_cast<std::uint32_t>(std::clamp(step, 0.0, kSteps));
  };
  std::vector<std::byte> bytes;
  for (const std::vector<Vec3f>& phase : structure.positions_m)
    for (const Vec3f p_m : phase) {
      const Vec3d mm = 1e3 * toDouble(p_m);
      append(bytes, stepOf(mm.x, steps.from_mm.x, steps.step_mm.x), 2);
      append(bytes, stepOf(mm.y, steps.from_mm.y, steps.step_mm.y), 2);
      append(bytes, stepOf(mm.z, steps.from_mm.z, steps.step_mm.z), 2);
    }
  return base64(bytes);
}

Json vectorJson(Vec3d v) {
  return {v.x, v.y, v.z};
}

Json structureJson(const ViewStructure& view, const Structure& structure, const Scene& scene) {
  const Steps steps = stepsOf(view);
  return {{"name", structure.name},
          {"medium", scene.medium(structure.medium).name},
          {"role", nameOf(roleOf(structure))},
          {"membrane", structure.membrane},
          {"keyframes", structure.keyframes.size()},
          {"seen", view.seen},
          {"triangles", view.triangles_given},
          {"shown", view.mesh.triangles.size()},
          {"probe_box_mm", boxJson(view.probe_box_m)},
          {"world_box_mm", boxJson(view.world_box_m)},
          {"from_mm", vectorJson(steps.from_mm)},
          {"step_mm", vectorJson(steps.step_mm)},
          {"vertices", view.mesh.vertices.size()},
          {"indices", indicesJson(view.mesh)},
          {"positions", positionsJson(view, steps)}};
}

Json pictureJson(const Scene& scene) {
  const PictureGeometry g = pictureGeometry(scene);
  return {{"width", scene.output.width},
          {"height", scene.output.height},
          {"origin_px", {g.origin_x_px, g.origin_y_px}},
          {"mm_per_px", millimetresFromMetres(g.metres_per_pixel)}};
}

}  // namespace

Json viewJson(const SceneView& view, const Scene& scene) {
  const Probe& probe = scene.probe;
  Json sector = Json::array(), structures = Json::array();
  for (const Vec3d p : view.sector_m)
    sector.push_back({shownMillimetres(p.x), shownMillimetres(p.z)});
  for (std::size_t s = 0; s < view.structures.size(); ++s)
    structures.push_back(structureJson(view.structures[s], scene.structures[s], scene));
  return {{"sight", view.sight},
          {"sees_any", view.sees_any},
          {"phases", view.phases},
          {"unit_mm", millimetresFromMetres(scene.motion.mesh_unit_m)},
          {"pose",
           {{"origin_mm", vectorJson(1e3 * probe.pose.origin)},
            {"lateral", vectorJson(probe.pose.x_axis)},
            {"elevation", vectorJson(probe.pose.y_axis)},
            {"depth", vectorJson(probe.pose.z_axis)}}},
          {"aperture_mm", millimetresFromMetres(probe.aperture_m)},
          {"lens_mm", millimetresFromMetres(probe.elevation_aperture_m)},
          {"sector_mm", sector},
          {"picture", pictureJson(scene)},
          {"structures", structures}};
}

}  // namespace echocine
