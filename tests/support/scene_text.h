#pragma once
// Scene files as text, built from a scene that works by changing a key or two.

#include <map>
#include <string>

#include "core/error.h"
#include "scene/scene_reader.h"
#include "support/meshes.h"

namespace echocine::support {

// `table` holds the lines of [table]; values are written as they are.
using Lines = std::map<std::string, std::string>;

inline std::string tableText(const std::string& head, const Lines& lines) {
  std::string text = lines.empty() ? "" : head + "\n";
  for (const auto& [key, value] : lines) text += key + " = " + value + "\n";
  return text;
}

struct SceneText {
  std::string background = "soft_tissue";
  Lines probe{{"apex", "[0, 0, 0]"},    {"axis", "[0, 0, 1]"}, {"lateral", "[1, 0, 0]"},
              {"sector_deg", "70"},     {"min_depth_mm", "2"}, {"depth_mm", "120"},
              {"frequency_mhz", "2.5"}, {"lines", "16"},       {"samples", "64"}};
  Lines acquisition{{"heart_rate_bpm", "60"}, {"frame_rate_hz", "5"}};
  Lines motion{{"mesh_unit", "\"cm\""}};
  Lines effects, signal, accuracy, output{{"width", "160"}, {"height", "120"}};
  std::string structures;  // [[structure]] tables as they are
  std::string media;       // [media.*] tables as they are
  std::string extra;       // anything else, at the end

  void setProbe(const std::string& key, const std::string& value) { probe[key] = value; }

  void addStructure(const std::string& name, const std::string& medium,
                    const std::string& keyframes, int priority = 1, const std::string& more = "") {
    structures += "[[structure]]\nname = \"" + name + "\"\nmedium = \"" + medium +
                  "\"\npriority = " + std::to_string(priority) + "\nkeyframes = " + keyframes +
                  "\n" + more + "\n";
  }

  std::string text() const {
    return "background = \"" + background + "\"\n" + tableText("[probe]", probe) +
           tableText("[acquisition]", acquisition) + tableText("[motion]", motion) +
           tableText("[effects]", effects) + tableText("[signal]", signal) +
           tableText("[accuracy]", accuracy) + tableText("[output]", output) + structures + media +
           extra;
  }

  // One structure `box` of a single keyframe box.obj.
  static SceneText oneBox(const std::string& medium) {
    SceneText text;
    text.addStructure("box", medium, "\"box.obj\"");
    return text;
  }
};

inline Scene parsed(const SceneText& text) {
  return parseScene(text.text(), "scene.toml");
}

// What the reader says of a scene it refuses; empty when it accepts it.
inline std::string refusalOf(const std::string& text,
                             const std::filesystem::path& file = "scene.toml") {
  try {
    parseScene(text, file);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

// The line of a text, counted from 1, that begins with `start`; 0 if there is none.
inline int lineOf(const std::string& text, const std::string& start) {
  int line = 1;
  for (std::size_t at = 0; at < text.size(); ++line) {
    if (text.compare(at, start.size(), start) == 0) return line;
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;
    at = end + 1;
  }
  return 0;
}

// Media that differ in sound speed, impedance and backscatter, and attenuate nothing.
inline constexpr const char* kGelOilMeat =
    "[media.gel]\ndensity_kg_m3 = 1050\nsound_speed_m_s = 1584\nattenuation_db_cm_mhz = 0\n"
    "backscatter = { kind = \"fixed\", per_cm_sr = 1e-6 }\n"
    "[media.oil]\ndensity_kg_m3 = 1150\nsound_speed_m_s = 1440\nattenuation_db_cm_mhz = 0\n"
    "backscatter = { kind = \"none\" }\n"
    "[media.meat]\ndensity_kg_m3 = 1300\nsound_speed_m_s = 1584\nattenuation_db_cm_mhz = 0\n"
    "backscatter = { kind = \"fixed\", per_cm_sr = 1e-4 }\n";

}  // namespace echocine::support
