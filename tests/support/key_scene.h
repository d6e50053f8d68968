#pragma once
// Scenes as single keys, so that a test can set each key of the table in a scene where it counts.

#include <fmt/format.h>

#include <map>
#include <string>

#include "scene/scene_keys.h"
#include "scene/scene_reader.h"

namespace echocine::support {

// Values of TOML by full key; one structure and one medium of the scene's own.
class KeyScene {
 public:
  // A ball that beats in a scene which accepts `key`.
  explicit KeyScene(const SceneKey& key) {
    const std::string name = key.fullName(), with = key.use.with ? key.use.with : "";
    for (const char* placed : {"probe.shift_mm", "probe.tilt_deg", "probe.rotate_deg"})
      if (name == placed) place();
    if (name == "probe.view") place();
    // Such as: kind = "linear".
    const std::size_t equals = with.find(" = \""), end = with.find('"', equals + 4);
    if (equals != std::string::npos)
      set(fmt::format("{}.{}", key.table, with.substr(0, equals)),
          with.substr(equals + 3, end - equals - 2));
    if (values_.count("probe.kind") > 0 && values_.at("probe.kind") == "\"linear\"") {
      values_.erase("probe.sector_deg");
      set("probe.width_mm", "40");
    }
    if (name == "structure.lids") set("structure.keyframes", "\"a.obj\"");
    if (name == "probe.depth_mm") set("probe.min_depth_mm", "0");
    if (name == "motion.keyframe_interval_ms") values_.erase("motion.keyframe_heart_rate_bpm");
    if (std::string_view(key.table) == "media.backscatter") setLaw(key.name);
    if (std::string_view(key.table) == "truth") set("truth.write", "[\"labels\"]");
  }

  void set(const std::string& key, const std::string& value) { values_[key] = value; }
  void remove(const std::string& key) { values_.erase(key); }

  std::string text() const {
    std::map<std::string, std::string> tables;
    std::string top;
    for (const auto& [key, value] : values_) {
      const std::size_t dot = key.rfind('.');
      std::string& lines = dot == std::string::npos ? top : tables[key.substr(0, dot)];
      lines += fmt::format("{} = {}\n", key.substr(dot == std::string::npos ? 0 : dot + 1), value);
    }
    for (const auto& [table, lines] : tables) top += headOf(table) + "\n" + lines;
    return top;
  }

  Scene scene() const { return parseScene(text(), "scene.toml"); }

  // What the reader says; empty when it accepts the scene.
  std::string refusal() const {
    try {
      scene();
    } catch (const SceneError& error) {
      return error.what();
    }
    return {};
  }

 private:
  static std::string headOf(const std::string& table) {
    if (table == "structure") return "[[structure]]";
    return table.starts_with("media") ? "[media.own" + table.substr(5) + "]" : "[" + table + "]";
  }
  void place() {
    for (const char* key : {"probe.apex", "probe.axis", "probe.lateral"}) values_.erase(key);
    set("probe.view", "\"a4c\"");
  }
  void setLaw(const std::string& key) {
    const std::string law = "media.backscatter.";
    if (key == "per_cm_sr") return;
    values_.erase(law + "per_cm_sr");
    if (key == "kind") return set(law + "kind", "\"none\"");
    if (key == "velocity_variation" || key == "correlation_length_um") {
      set(law + "kind", "\"tissue\"");
      set(law + "velocity_variation", "0.01");
      set(law + "correlation_length_um", "50");
      return;
    }
    set(law + "kind", "\"blood\"");
    set(law + "hematocrit", "0.4");
    set(law + "cell_radius_um", "2.75");
    set(law + "cell_density_kg_m3", "1099");
    set(law + "cell_compressibility_cm2_dyn", "3.41e-11");
  }

  std::map<std::string, std::string> values_{{"probe.apex", "[0, 0, 0]"},
                                             {"probe.axis", "[0, 0, 1]"},
                                             {"probe.lateral", "[1, 0, 0]"},
                                             {"probe.sector_deg", "70"},
                                             {"probe.depth_mm", "120"},
                                             {"probe.frequency_mhz", "2.5"},
                                             {"probe.lines", "16"},
                                             {"probe.samples", "64"},
                                             {"motion.keyframe_heart_rate_bpm", "70"},
                                             {"structure.name", "\"ball\""},
                                             {"structure.medium", "\"own\""},
                                             {"structure.keyframes", "[\"a.obj\", \"b.obj\"]"},
                                             {"media.density_kg_m3", "1050"},
                                             {"media.sound_speed_m_s", "1550"},
                                             {"media.attenuation_db_cm_mhz", "0.5"},
                                             {"media.backscatter.kind", "\"fixed\""},
                                             {"media.backscatter.per_cm_sr", "1e-4"}};
};

inline KeyOwner ownerOf(Scene& scene) {
  return {&scene, &scene.structures.front()};
}

inline bool isNumber(const SceneKey& key) {
  return key.field.kind == KeyKind::number || key.field.kind == KeyKind::whole;
}

// A number of an SI unit, as the key's member has it.
inline KeyValue inCode(const SceneKey& key, double si) {
  if (key.field.kind == KeyKind::whole) return static_cast<std::int64_t>(si);
  return si;
}

}  // namespace echocine::support
