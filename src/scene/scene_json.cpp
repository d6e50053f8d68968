#include "scene/scene_json.h"

#include <nlohmann/json.hpp>

#include "scene/scene_keys.h"
#include "scene/view_names.h"

namespace echocine {

namespace {

using Json = nlohmann::ordered_json;

Json jsonOf(const KeyValue& value) {
  return std::visit(
      [](const auto& v) -> Json {
        if constexpr (std::is_same_v<std::decay_t<decltype(v)>, std::monostate>)
          return Json();
        else
          return v;
      },
      value);
}

// Adds the members of a table's keys, by their names in the structs.
void addKeys(const char* table, const KeyOwner& owner, Json& json) {
  for (const SceneKey& key : sceneKeys())
    if (key.field.member != nullptr && std::string_view(table) == key.table)
      json[key.field.member] = jsonOf(key.field.get(owner));
}

Json vectorJson(Vec3d v) {
  return Json::array({v.x, v.y, v.z});
}

void addPose(const Scene& scene, Json& json) {
  const Probe& p = scene.probe;
  json["apex_m"] = vectorJson(p.pose.origin);
  json["lateral"] = vectorJson(p.pose.x_axis);
  json["elevation"] = vectorJson(p.pose.y_axis);
  json["axis"] = vectorJson(p.pose.z_axis);
  json["first_angle_rad"] = p.first_angle_rad;
  json["last_angle_rad"] = p.last_angle_rad;
  json["first_offset_m"] = p.first_offset_m;
  json["last_offset_m"] = p.last_offset_m;
  if (!scene.view) return;  // where it is still to be found
  json["view"] = keyOf(scene.view->view);
  json["view_shift_m"] = vectorJson(scene.view->shift_m);
  json["view_tilt_rad"] = scene.view->tilt_rad;
  json["view_rotate_rad"] = scene.view->rotate_rad;
}

Json repairJson(const Repairs& r) {
  Json words = Json::array();
  if (r.weld) words.push_back("weld");
  if (r.drop_degenerate) words.push_back("drop-degenerate");
  if (r.orient) words.push_back("orient");
  if (r.split) words.push_back("split");
  if (r.fill_holes) words.push_back("fill-holes");
  return words;
}

// As a scene names it, from the scene's folder; an absolute path is nobody's business but its name.
std::string fileFrom(const std::filesystem::path& scene, const std::filesystem::path& file) {
  const std::filesystem::path from = file.lexically_relative(scene.parent_path());
  return from.empty() ? file.filename().string() : from.generic_string();
}

Json keyframesJson(const Scene& scene, const Structure& structure) {
  Json keyframes = Json::array();
  for (const Keyframe& k : structure.keyframes) {
    Json files = Json::array();
    for (const auto& file : k.files) files.push_back(fileFrom(scene.file, file));
    keyframes.push_back({{"files", files}, {"phase", k.phase}});
  }
  return keyframes;
}

Json structuresJson(Scene& scene) {
  Json list = Json::array();
  for (Structure& s : scene.structures) {
    Json json{{"name", s.name}};
    addKeys("structure", {&scene, &s}, json);
    json["medium"] = scene.medium(s.medium).name;
    json["repair"] = repairJson(s.repair);
    json["keyframes"] = keyframesJson(scene, s);
    list.push_back(std::move(json));
  }
  return list;
}

Json channelsJson(const OutputSettings& o) {
  Json channels = Json::array();
  for (const Channel c : o.channels) channels.push_back(channelName(c));
  return channels;
}

Json gainTableJson(const SignalSettings& s) {
  Json table = Json::array();
  for (const auto& [depth_m, gain_db] : s.tgc_table) table.push_back({depth_m, gain_db});
  return table;
}

void addTruth(const TruthSettings& t, Json& json) {
  json["labels"] = t.labels;
  json["contours"] = t.contours;
  json["tracks"] = t.tracks;
  json["function"] = t.function;
  json["label_numbers"] = Json::object();
  for (const auto& [name, number] : t.label_numbers) json["label_numbers"][name] = number;
  json["papillary_in_cavity"] = t.papillary_in_cavity;
}

}  // namespace

Json mediaJson(const Scene& scene) {
  Json media = Json::object();
  for (const Medium& m : scene.media)
    media[m.name] = {{"Z", m.impedance_kg_m2_s},
                     {"c", m.sound_speed_m_s},
                     {"alpha_np_per_m", m.attenuation_np_per_m},
                     {"eta_b_per_m_sr", m.backscatter_per_m_sr},
                     {"blood", m.blood}};
  return media;
}

Json sceneJson(const Scene& scene) {
  // Fields give access for the reader too; nothing is changed here.
  Scene& fields = const_cast<Scene&>(scene);
  Json json{{"background", scene.medium(scene.background).name}};
  addKeys("", {&fields}, json);
  for (const char* table : {"probe", "acquisition", "motion", "effects", "signal", "accuracy",
                            "output", "truth", "trabeculae", "leaflets", "speckle", "artefacts"}) {
    json[table] = Json::object();
    addKeys(table, {&fields}, json[table]);
  }
  addPose(scene, json["probe"]);
  json["motion"]["mesh_unit_m"] = scene.motion.mesh_unit_m;
  json["motion"]["mesh_offset_m"] = vectorJson(scene.motion.mesh_offset_m);
  json["structures"] = structuresJson(fields);
  json["signal"]["tgc_table_m_db"] = gainTableJson(scene.signal);
  json["output"]["channels"] = channelsJson(scene.output);
  addTruth(scene.truth, json["truth"]);
  return json;
}

}  // namespace echocine
