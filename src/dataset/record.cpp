#include "dataset/record.h"

#include "scene/view_names.h"

namespace echocine::dataset {

namespace {

Json offsetJson(const std::optional<ViewOffset>& offset) {
  Json json{{"label", nullptr},
            {"tilt_deg", nullptr},
            {"rotation_deg", nullptr},
            {"shift_mm", nullptr},
            {"foreshortening_mm", nullptr}};
  if (!offset) return json;
  json["label"] = offset->label;
  if (json["label"] == "other") return json;  // no standard view to compare with
  json["tilt_deg"] = offset->tilt_deg;
  json["shift_mm"] = offset->shift_mm;
  if (offset->rotation_deg) json["rotation_deg"] = *offset->rotation_deg;
  if (offset->foreshortening_mm) json["foreshortening_mm"] = *offset->foreshortening_mm;
  return json;
}

Json loopJson(const LoopSample& loop) {
  const LoopFrame& ed = loop.frames[static_cast<std::size_t>(loop.instants.ed)];
  const LoopFrame& es = loop.frames[static_cast<std::size_t>(loop.instants.es)];
  Json json{{"id", loop.id},
            {"view", keyOf(loop.view)},
            {"frames", loop.frames.size()},
            {"frame_rate_hz", loop.scene.acquisition.frame_rate_hz},
            {"width", loop.width()},
            {"height", loop.height()},
            {"mm_per_pixel", 1e3 * loop.geometry.metres_per_pixel},
            {"ed_frame", loop.instants.ed},
            {"es_frame", loop.instants.es},
            {"edv_ml", ed.lv_ml},
            {"esv_ml", es.lv_ml},
            {"ef_percent", ejectedPercent(ed.lv_ml, es.lv_ml)},
            {"edv_biplane_ml", ed.biplane_ml},
            {"esv_biplane_ml", es.biplane_ml},
            {"ef_biplane_percent", ejectedPercent(ed.biplane_ml, es.biplane_ml)},
            {"edv_single_plane_ml", ed.single_plane_ml},
            {"esv_single_plane_ml", es.single_plane_ml},
            {"ef_single_plane_percent", ejectedPercent(ed.single_plane_ml, es.single_plane_ml)},
            {"length_in_plane_mm", 1e3 * ed.traced_length_m}};
  // Measured; what was drawn for it is "offset".
  json["view_offset"] = offsetJson(loop.offset);
  json["drawn"] = jsonOf(loop.values);
  return json;
}

}  // namespace

double ejectedPercent(double ed_ml, double es_ml) {
  return ed_ml > 0 ? 100 * (1 - es_ml / ed_ml) : 0;
}

Json jsonOf(const Values& values) {
  Json json = Json::object();
  for (const auto& [name, value] : values)
    std::visit([&, n = name](const auto& v) { json[n] = v; }, value);
  return json;
}

Json recordOf(const Spec& spec, const Heart& heart) {
  Json record{{"spec", spec.heart_digest},      {"heart", heart.number},
              {"population", heart.population}, {"split", nameOf(heart.split)},
              {"attempt", heart.attempt},       {"impossible", heart.impossible},
              {"layouts", spec.layouts},        {"loops", Json::array()}};
  for (const LoopSample& loop : heart.loops) record["loops"].push_back(loopJson(loop));
  return record;
}

Json failureOf(const Spec& spec, int heart, const std::string& reason) {
  return {
      {"spec", spec.heart_digest}, {"heart", heart + 1}, {"seed", spec.seed}, {"failed", reason}};
}

bool isFailure(const Json& record) {
  return record.contains("failed");
}

}  // namespace echocine::dataset
