#include "output/manifest.h"

#include <nlohmann/json.hpp>

#include "core/file.h"
#include "output/exr_stack.h"
#include "scene/scene_json.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

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

Json keyframesJson(const Manifest& manifest) {
  Json keyframes = Json::object();
  for (const KeyframeVolume& k : manifest.keyframes)
    keyframes[k.structure].push_back({{"phase", k.phase}, {"volume_ml", k.volume_ml}});
  return keyframes;
}

}  // namespace

Json effectsJson(const Manifest& manifest) {
  Json effects = Json::array();
  for (const EffectDecision& e : manifest.plan.effects.decisions)
    effects.push_back({{"name", e.name},
                       {"on", e.on},
                       {"reason", e.reason},
                       {"time_share", timeShare(e, manifest)}});
  return effects;
}

Json planJson(const LoopPlan& plan) {
  Json interfaces = Json::array();
  for (const EffectDecision& i : plan.interfaces)
    interfaces.push_back({{"name", i.name}, {"on", i.on}, {"reason", i.reason}});
  return {{"tracer", plan.tracerName()},
          {"tracer_reason", plan.tracer_reason},
          {"rays_per_beam", plan.effects.rays_per_beam},
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
  const WorkCounts& w = manifest.work;
  const auto crossings = static_cast<double>(w.crossings), rays = static_cast<double>(w.rays),
             scattered = static_cast<double>(w.samples_backscatter),
             attenuated = static_cast<double>(w.samples_attenuated);
  // Relative cost of a unit of each work: our choice, weighed by the operations of each, not timed.
  struct Part {
    const char* name;
    Stage stage;
    double work;
  };
  const Part parts[] = {{"reflection", Stage::trace, 20 * crossings},
                        {"lobe", Stage::trace, 5 * crossings},
                        {"transmission_loss", Stage::trace, 10 * crossings},
                        {"refraction", Stage::trace, manifest.plan.slice ? 0 : 200 * rays},
                        {"attenuation", Stage::trace, 0.5 * attenuated},
                        {"backscatter", Stage::trace, 0.3 * scattered},
                        {"spread", Stage::trace, 0.3 * scattered},
                        {"elevation", Stage::trace, 20 * rays},
                        {"travel_time", Stage::trace, 2 * crossings},
                        {"labels", Stage::trace, 0.1 * scattered},
                        {"speckle", Stage::speckle, 1},
                        {"beam_width", Stage::signal, 0.8},
                        {"tgc", Stage::signal, 0.05},
                        {"log_compression", Stage::signal, 0.2}};
  double of_stage = 0;
  const Part* part = nullptr;
  for (const Part& p : parts)
    if (effect.name == p.name) part = &p;
  const bool channel = effect.name.starts_with("channel");
  if (!part && !channel) return 0;
  for (const EffectDecision& other : manifest.plan.effects.decisions)
    for (const Part& p : parts)
      if (part && other.on && other.name == p.name && p.stage == part->stage) of_stage += p.work;
  if (channel) {
    double channels = 0;
    for (const EffectDecision& other : manifest.plan.effects.decisions)
      channels += other.on && other.name.starts_with("channel") ? 1 : 0;
    return manifest.stage_ms[static_cast<std::size_t>(Stage::exr)] / total / channels;
  }
  const double stage_ms = manifest.stage_ms[static_cast<std::size_t>(part->stage)];
  return of_stage > 0 ? stage_ms / total * part->work / of_stage : 0;
}

void writeManifest(const std::filesystem::path& path, const Scene& scene,
                   const Manifest& manifest) {
  Json timings = stageTimesJson(manifest);
  timings["wall"] = manifest.wall_ms;
  const Json json{{"version", ECHOCINE_VERSION},
                  {"scene_sha256", manifest.scene_sha256},
                  {"scene", sceneJson(scene)},
                  {"media", mediaJson(scene)},
                  {"effects", effectsJson(manifest)},
                  {"plan", planJson(manifest.plan)},
                  {"accuracy", accuracyJson(manifest.accuracy)},
                  {"warnings", manifest.warnings},
                  {"reference_intensity", manifest.reference_intensity},
                  {"loop_frames", manifest.loop_frames},
                  {"frames", framesJson(manifest)},
                  {"keyframe_volumes", keyframesJson(manifest)},
                  {"timings_ms_per_frame", timings},
                  {"work", workJson(manifest.work)},
                  {"files", manifest.files}};
  const std::string text = json.dump(1) + "\n";
  writeFileWhole(path, std::as_bytes(std::span(text)));
}

}  // namespace echocine
