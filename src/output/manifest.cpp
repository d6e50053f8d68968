#include "output/manifest.h"

#include <nlohmann/json.hpp>

#include "core/file.h"
#include "output/exr_stack.h"
#include "scene/scene_json.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

// An effect's share of the stages' time: its own stage is the finest that is measured, so shares are those of
// the stages that carry it out.
double timeShare(const EffectDecision& effect, const Manifest& manifest) {
  double total = 0;
  for (const double ms : manifest.stage_ms) total += ms;
  if (!effect.on || total <= 0) return 0;
  const double trace = manifest.stage_ms[static_cast<std::size_t>(Stage::trace)];
  int on = 0;
  for (const EffectDecision& other : manifest.plan.decisions) on += other.on ? 1 : 0;
  return trace / total / on;
}

Json effectsJson(const Manifest& manifest) {
  Json effects = Json::array();
  for (const EffectDecision& e : manifest.plan.decisions)
    effects.push_back({{"name", e.name},
                       {"on", e.on},
                       {"reason", e.reason},
                       {"time_share", timeShare(e, manifest)}});
  return effects;
}

Json framesJson(const Manifest& manifest) {
  Json frames = Json::array();
  for (const FrameEntry& f : manifest.frames) {
    Json volumes = Json::object();
    for (const auto& [name, ml] : f.volumes_ml) volumes[name] = ml;
    const bool exr = !f.exr_sha256.empty();
    frames.push_back({{"index", f.record.frame},
                      {"time_s", f.record.time_s},
                      {"phase", f.record.phase},
                      {"volumes_ml", volumes},
                      {"exr", exr ? Json("intensity/" + ExrStack::fileName(f.record.frame)) : Json()},
                      {"sha256", exr ? Json(f.exr_sha256) : Json()}});
  }
  return frames;
}

Json keyframesJson(const Manifest& manifest) {
  Json keyframes = Json::object();
  for (const KeyframeVolume& k : manifest.keyframes)
    keyframes[k.structure].push_back({{"phase", k.phase}, {"volume_ml", k.volume_ml}});
  return keyframes;
}

}  // namespace

const char* stageName(Stage stage) {
  static constexpr const char* kNames[kStages] = {"motion", "geometry", "trace", "signal",
                                                  "scan_conversion", "exr", "avi"};
  return kNames[static_cast<std::size_t>(stage)];
}

void writeManifest(const std::filesystem::path& path, const Scene& scene,
                   const Manifest& manifest) {
  Json timings = Json::object();
  for (std::size_t s = 0; s < kStages; ++s)
    timings[stageName(static_cast<Stage>(s))] = manifest.stage_ms[s];
  timings["wall"] = manifest.wall_ms;
  const WorkCounts& w = manifest.work;
  const Json json{{"version", ECHOCINE_VERSION},
                  {"scene_sha256", manifest.scene_sha256},
                  {"scene", sceneJson(scene)},
                  {"media", mediaJson(scene)},
                  {"effects", effectsJson(manifest)},
                  {"reference_intensity", manifest.reference_intensity},
                  {"loop_frames", manifest.loop_frames},
                  {"frames", framesJson(manifest)},
                  {"keyframe_volumes", keyframesJson(manifest)},
                  {"timings_ms_per_frame", timings},
                  {"work",
                   {{"bvh_updates", w.bvh_updates},
                    {"facets_sliced", w.facets_sliced},
                    {"rays", w.rays},
                    {"crossings", w.crossings},
                    {"samples_backscatter", w.samples_backscatter},
                    {"samples_attenuated", w.samples_attenuated}}},
                  {"files", manifest.files}};
  const std::string text = json.dump(1) + "\n";
  writeFileWhole(path, std::as_bytes(std::span(text)));
}

}  // namespace echocine
