#include "cli/interpolation_table.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "core/units.h"
#include "motion/keyframes/interpolation_judge.h"
#include "motion/surfaces/mesh_motion.h"
#include "scene/names.h"

namespace echocine {

namespace {

struct Row {
  std::string name;
  std::array<std::optional<InterpolationError>, kInterpolationKinds> errors;
};

// One row per structure with keyframes to leave out, the last over all of them.
std::vector<Row> judged(const Scene& scene) {
  const MeshMotion motion(scene);
  std::vector<Row> rows;
  std::array<std::vector<InterpolationError>, kInterpolationKinds> of_kind;
  for (std::size_t s = 0; s < scene.structures.size(); ++s) {
    Row row{scene.structures[s].name, {}};
    bool any = false;
    for (std::size_t k = 0; k < kInterpolationKinds; ++k) {
      row.errors[k] =
          judgeInterpolation(motion.control(static_cast<SurfaceId>(s)), kInterpolations[k]);
      if (row.errors[k]) of_kind[k].push_back(*row.errors[k]);
      any = any || row.errors[k];
    }
    if (any) rows.push_back(row);
  }
  if (rows.empty())
    throw SceneError(atPlace(scene.structures.front().place,
                             "too few keyframes to omit some, accepted: four or more"));
  Row all{"all", {}};
  for (std::size_t k = 0; k < kInterpolationKinds; ++k)
    if (of_kind[k].size() == rows.size()) all.errors[k] = pooled(of_kind[k]);
  rows.push_back(all);
  return rows;
}

nlohmann::ordered_json rowJson(const Row& row) {
  nlohmann::ordered_json kinds = nlohmann::ordered_json::object();
  for (std::size_t k = 0; k < kInterpolationKinds; ++k) {
    const std::optional<InterpolationError>& e = row.errors[k];
    if (!e) continue;
    auto& json = kinds[nameOf(kInterpolations[k])];
    json = {{"vertex_rms_mm", millimetresFromMetres(e->vertex_rms_m)},
            {"vertex_max_mm", millimetresFromMetres(e->vertex_max_m)}};
    if (e->volumes == 0) continue;
    json["volume_rms_ml"] = millilitresFromCubicMetres(e->volume_rms_m3);
    json["volume_max_ml"] = millilitresFromCubicMetres(e->volume_max_m3);
    json["volume_max_share"] = e->volume_max_share;
  }
  return kinds;
}

void printCells(const Row& row, double (*cell)(const InterpolationError&), bool volume) {
  for (const std::optional<InterpolationError>& e : row.errors)
    fmt::print(" {:>11}", !e                          ? "refused"
                          : volume && e->volumes == 0 ? "-"
                                                      : fmt::format("{:.3f}", cell(*e)));
  fmt::print("\n");
}

void printBlock(const std::vector<Row>& rows, const char* title,
                double (*cell)(const InterpolationError&), bool volume) {
  fmt::print("{:<28}", title);
  for (const Interpolation kind : kInterpolations) fmt::print(" {:>11}", nameOf(kind));
  fmt::print("\n");
  for (const Row& row : rows) {
    if (volume && row.errors[0] && row.errors[0]->volumes == 0) continue;
    fmt::print("  {:<26}", row.name);
    printCells(row, cell, volume);
  }
}

}  // namespace

void printInterpolation(const Scene& scene, bool as_json) {
  const std::vector<Row> rows = judged(scene);
  if (as_json) {
    nlohmann::ordered_json json = nlohmann::ordered_json::object();
    for (const Row& row : rows) json[row.name] = rowJson(row);
    fmt::print("{}\n", json.dump(1));
    return;
  }
  fmt::print("every other keyframe omitted and interpolated from the rest\n\n");
  using E = const InterpolationError&;
  printBlock(
      rows, "vertices, RMS in mm", [](E e) { return millimetresFromMetres(e.vertex_rms_m); },
      false);
  printBlock(
      rows, "volume, RMS in mL", [](E e) { return millilitresFromCubicMetres(e.volume_rms_m3); },
      true);
  printBlock(
      rows, "volume, worst in mL", [](E e) { return millilitresFromCubicMetres(e.volume_max_m3); },
      true);
  printBlock(
      rows, "volume, worst in % of the largest", [](E e) { return 100 * e.volume_max_share; },
      true);
}

}  // namespace echocine
