#include "output/manifest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/file.h"
#include "core/seal.h"
#include "core/units.h"
#include "output/exr_stack.h"
#include "scene/probe_pose.h"
#include "scene/role.h"
#include "scene/scan_geometry.h"
#include "scene/scene_json.h"
#include "scene/white_rule.h"
#include "signal/picture.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

// null where a run writes no EXR: the keys are the same in every manifest.
Json framesJson(const Manifest& manifest) {
  Json frames = Json::array();
  for (const FrameEntry& f : manifest.frames) {
    Json volumes = Json::object();
    for (const auto& [name, ml] : f.volumes_ml) volumes[name] = ml;
    const bool exr = !f.exr_sha256.empty();
    frames.push_back(
        {{"index", f.record.frame},
         {"time_s", f.record.time_s},
         {"phase", f.record.phase},
         {"beat", f.record.beat},
         {"volumes_ml", volumes},
         {"exr", exr ? Json("intensity/" + ExrStack::fileName(f.record.frame)) : Json()},
         {"sha256", exr ? Json(f.exr_sha256) : Json()}});
  }
  return frames;
}

// Where the probe frame lies in the picture. Pixel (i, j) covers i..i+1, j..j+1.
Json pictureJson(const Scene& scene) {
  const PictureGeometry g = pictureGeometry(scene);
  const double mm_per_pixel = millimetresFromMetres(g.metres_per_pixel);
  Json edges = Json::array();
  Probe outer = scene.probe;
  outer.lines = 2;
  for (int i = 0; i < outer.lines && !outer.isFullTurn(); ++i) {
    const LineGeometry line = lineGeometry(outer, i);
    const auto px = [&](double path_m) {
      const PixelPoint at = pixelOf(g, line.origin + path_m * line.direction);
      return Json{at.x, at.y};
    };
    edges.push_back(
        {{"from_px", px(scene.probe.min_depth_m)},
         {"to_px", px(scene.probe.max_depth_m)},
         {"angle_deg", degreesFromRadians(std::atan2(line.direction.x, line.direction.z))}});
  }
  return {
      {"width_px", scene.output.width},
      {"height_px", scene.output.height},
      {"mm_per_pixel", mm_per_pixel},
      {"apex_px", {g.origin_x_px, g.origin_y_px}},
      {"px_from_mm", {{1 / mm_per_pixel, 0, g.origin_x_px}, {0, 1 / mm_per_pixel, g.origin_y_px}}},
      {"sector_edges", edges}};
}

// The frames of the largest and the smallest left ventricle; null without one.
Json eventsJson(const Scene& scene, const Manifest& manifest) {
  const auto ventricle = structureOf(scene, Role::lv_cavity);
  if (!ventricle || manifest.frames.empty()) return {};
  const std::string& name = scene.structures[index(*ventricle)].name;
  const auto volume = [&](const FrameEntry& frame) {
    for (const auto& [structure, ml] : frame.volumes_ml)
      if (structure == name) return ml;
    return 0.0;
  };
  const auto by_volume = [&](const FrameEntry& a, const FrameEntry& b) {
    return volume(a) < volume(b);
  };
  const auto [least, most] =
      std::minmax_element(manifest.frames.begin(), manifest.frames.end(), by_volume);
  const double full_ml = volume(*most), empty_ml = volume(*least);
  return {{"structure", name},
          {"end_diastole_frame", most->record.frame},
          {"end_systole_frame", least->record.frame},
          {"end_diastolic_volume_ml", full_ml},
          {"end_systolic_volume_ml", empty_ml},
          {"ejection_fraction", full_ml > 0 ? 1 - empty_ml / full_ml : 0}};
}

Json curvesJson(const Manifest& manifest) {
  Json curves = Json::object();
  for (const auto& [name, values] : manifest.curves) curves[name] = values;
  return curves;
}

// Grouped by structure, as curves are drawn. Lists are made before they are filled: push_back() on
// null, short of memory, leaves a list without its place, which is then destroyed.
Json keyframesJson(const Manifest& manifest) {
  Json keyframes = Json::object();
  for (const KeyframeVolume& k : manifest.keyframes)
    keyframes.emplace(k.structure, Json::array())
        .first.value()
        .push_back({{"phase", k.phase}, {"volume_ml", k.volume_ml}});
  return keyframes;
}

const EffectRow& rowOf(Effect effect) {
  return *std::find_if(std::begin(kEffects), std::end(kEffects),
                       [&](const EffectRow& row) { return row.effect == effect; });
}

// Relative time that an effect took: its costs times the work counted.
double costOf(Effect effect, const Manifest& manifest) {
  const EffectCost& cost = rowOf(effect).cost;
  const WorkCounts& w = manifest.work;
  const auto crossings = static_cast<double>(w.crossings), rays = static_cast<double>(w.rays),
             scattered = static_cast<double>(w.samples_backscatter),
             attenuated = static_cast<double>(w.samples_attenuated);
  // The slice tracer bends no ray.
  if (effect == Effect::refraction && manifest.plan.slice) return 0;
  // Each slice beside the plane repeats all work of the plane.
  const double beside = manifest.plan.effects.elevation_slices - 1;
  if (effect == Effect::elevation && beside > 0)
    return beside * (35 * crossings + 0.6 * scattered + 0.5 * attenuated);
  return cost.crossing * crossings + cost.ray * rays + cost.scattered * scattered +
         cost.attenuated * attenuated + cost.fixed;
}

}  // namespace

Json effectsJson(const Manifest& manifest) {
  Json effects = Json::array();
  for (const EffectDecision& e : manifest.plan.effects.decisions)
    effects.push_back({{"name", e.name()},
                       {"on", e.on},
                       {"reason", e.reason},
                       {"time_share", timeShare(e, manifest)}});
  return effects;
}

Json planJson(const LoopPlan& plan) {
  Json interfaces = Json::array();
  for (const Omission& i : plan.interfaces)
    interfaces.push_back({{"name", i.name}, {"on", false}, {"reason", i.reason}});
  return {{"tracer", plan.tracerName()},
          {"tracer_reason", plan.tracer_reason},
          {"rays_per_beam", plan.effects.rays_per_beam},
          {"elevation_slices", plan.effects.elevation_slices},
          {"interface_echo", plan.cell_echoes ? "cell" : "centre"},
          {"interface_echo_reason", plan.echo_reason},
          {"left_out", interfaces},
          {"triangles",
           {{"given", plan.triangles_given},
            {"kept", plan.triangles_kept},
            {"met", plan.triangles_met}}}};
}

Json stageTimesJson(const Manifest& manifest) {
  Json timings = Json::object();
  for (std::size_t s = 0; s < kStages; ++s)
    timings[stageName(static_cast<Stage>(s))] = manifest.stage_ms[s];
  return timings;
}

Json workJson(const WorkCounts& w) {
  return {{"bvh_updates", w.bvh_updates},
          {"facets_sliced", w.facets_sliced},
          {"rays", w.rays},
          {"crossings", w.crossings},
          {"samples_backscatter", w.samples_backscatter},
          {"samples_attenuated", w.samples_attenuated}};
}

double timeShare(const EffectDecision& effect, const Manifest& manifest) {
  double total = 0;
  for (const double ms : manifest.stage_ms) total += ms;
  if (!effect.on || total <= 0) return 0;
  const Stage stage = rowOf(effect.effect).stage;
  double of_stage = 0;
  for (const EffectDecision& other : manifest.plan.effects.decisions)
    if (other.on && rowOf(other.effect).stage == stage) of_stage += costOf(other.effect, manifest);
  const double stage_ms = manifest.stage_ms[static_cast<std::size_t>(stage)];
  return of_stage > 0 ? stage_ms / total * costOf(effect.effect, manifest) / of_stage : 0;
}

// Written last and whole: its presence says that the run is finished.
void writeManifest(const std::filesystem::path& path, const Scene& scene,
                   const Manifest& manifest) {
  Json timings = stageTimesJson(manifest);
  timings["wall"] = manifest.wall_ms;
  const Json json{{"version", ECHOCINE_VERSION},
                  {"scene_sha256", manifest.scene_sha256},
                  {"scene", sceneJson(scene)},
                  {"probe_toml", poseToml(scene)},
                  {"media", mediaJson(scene)},
                  {"effects", effectsJson(manifest)},
                  {"plan", planJson(manifest.plan)},
                  {"accuracy", accuracyJson(manifest.accuracy)},
                  {"warnings", manifest.warnings},
                  {"reference_intensity", manifest.reference_intensity},
                  {"white", whiteWords(scene)},
                  {"loop_frames", manifest.loop_frames},
                  {"picture", pictureJson(scene)},
                  {"left_ventricle", eventsJson(scene, manifest)},
                  {"frames", framesJson(manifest)},
                  {"curves", curvesJson(manifest)},
                  {"keyframe_volumes", keyframesJson(manifest)},
                  {"timings_ms_per_frame", timings},
                  {"work", workJson(manifest.work)},
                  {"files", manifest.files}};
  const std::string text = sealed(json.dump(1));
  writeFileWhole(path, std::as_bytes(std::span(text)));
}

}  // namespace echocine
