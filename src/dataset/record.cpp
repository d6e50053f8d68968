#include "dataset/record.h"

#include <fmt/format.h>

#include "dataset/decorrelation.h"
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

Json decorrelationJson(const LoopSample& loop) {
  const Decorrelation curve = decorrelationOf(loop);
  return {{"blocks", curve.blocks},
          {"lag_ms", curve.lag_ms},
          {"correlation", curve.correlation},
          {"out_of_plane_mm", curve.out_of_plane_mm}};
}

// Share of the ventricle's outline that the picture shows, by length; null without an outline.
Json visibleShare(const LoopSample& loop, const LoopFrame& frame) {
  double all_m = 0, visible_m = 0;
  for (const Contour& contour : frame.contours) {
    if (roleOf(loop.scene.structures[index(contour.surface)]) != Role::lv_cavity) continue;
    const std::size_t count = contour.visible.size();
    for (std::size_t i = contour.closed ? 0 : 1; i < count; ++i) {
      const std::size_t before = (i + count - 1) % count;
      const double length_m = length(contour.points_m[i] - contour.points_m[before]);
      all_m += length_m;
      visible_m += 0.5 * length_m * (contour.visible[i] + contour.visible[before]);
    }
  }
  return all_m > 0 ? Json(visible_m / all_m) : Json();
}

// Share of the tracked points that are in the picture, over all frames; null without points.
Json shownShare(const LoopSample& loop) {
  std::size_t all = 0, shown = 0;
  for (const LoopFrame& frame : loop.frames) {
    all += frame.tracks_m.size();
    for (const Vec3f place_m : frame.tracks_m) shown += isShown(loop, place_m);
  }
  return all > 0 ? Json(static_cast<double>(shown) / static_cast<double>(all)) : Json();
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
            {"edv_single_plane_ml", nullptr},
            {"esv_single_plane_ml", nullptr},
            {"ef_single_plane_percent", nullptr},
            {"length_in_plane_mm", nullptr},
            {"border_visible_ed", visibleShare(loop, ed)},
            {"border_visible_es", visibleShare(loop, es)},
            {"tracks_visible", shownShare(loop)}};
  if (ed.traced_length_m > 0 && es.traced_length_m > 0) {
    json["edv_single_plane_ml"] = ed.single_plane_ml;
    json["esv_single_plane_ml"] = es.single_plane_ml;
    json["ef_single_plane_percent"] = ejectedPercent(ed.single_plane_ml, es.single_plane_ml);
    json["length_in_plane_mm"] = 1e3 * ed.traced_length_m;
  }
  json["decorrelation"] = decorrelationJson(loop);
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

Json marksJson(const std::map<std::string, FileMark>& files) {
  Json json = Json::object();
  for (const auto& [name, mark] : files)
    json[name] = {{"bytes", mark.bytes}, {"digest", mark.digest}};
  return json;
}

Json recordOf(const Spec& spec, const Heart& heart) {
  Json record{{"spec", spec.heart_digest},      {"heart", heart.number},
              {"population", heart.population}, {"split", nameOf(heart.split)},
              {"attempt", heart.attempt},       {"impossible", heart.impossible},
              {"layouts", spec.layouts},        {"loops", Json::array()}};
  if (!spec.scenes.empty()) record["scene"] = spec.sceneOf(heart.number - 1).name;
  for (const LoopSample& loop : heart.loops) record["loops"].push_back(loopJson(loop));
  return record;
}

std::string groupOf(const Json& record) {
  return record.contains("scene") ? record["scene"].get<std::string>()
                                  : fmt::format("heart {}", record.at("heart").get<int>());
}

Json failureOf(const Spec& spec, int heart, const std::string& reason) {
  return {
      {"spec", spec.heart_digest}, {"heart", heart + 1}, {"seed", spec.seed}, {"failed", reason}};
}

bool isFailure(const Json& record) {
  return record.contains("failed");
}

}  // namespace echocine::dataset
