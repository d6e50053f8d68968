#pragma once
// Studies of a small ball by the command.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/loop_scene.h"
#include "support/run_program.h"

namespace echocine::support {

using Json = nlohmann::ordered_json;

// Control meshes of few faces and a wall that bends rays, so that every knob has something to do.
inline SceneText studiedBall() {
  SceneText text = ballScene(6);
  text.structures.replace(text.structures.find("myocardium"), 10, "fat");
  text.probe["depth_mm"] = "110";
  text.motion["subdivision"] = "1";
  makeCoarse(text);
  return text;
}

class StudiedBall : public ::testing::Test {
 protected:
  StudiedBall() { writeBall(folder, studiedBall()); }
  Outcome study(const std::string& more = "", const std::string& out = "out") {
    const bool repeats = more.find("--repeats") != std::string::npos;
    return runShell("%B study '" + (folder / "scene.toml").string() + "' -o '" +
                    (folder / out).string() + "' --frames 2 " + (repeats ? "" : "--repeats 1 ") +
                    more);
  }
  Json json(const std::string& out = "out") const {
    return Json::parse(bytesOf(folder / out / "study.json"));
  }
  TempFolder folder;
};

// All that may differ from run to run.
inline Json withoutTimes(Json json) {
  json.erase("machine");
  for (Json& row : json["rows"]) row.erase("timing");
  return json;
}

inline const Json& rowOf(const Json& json, const std::string& sweep, const std::string& knob,
                         const std::string& value) {
  for (const Json& row : json["rows"])
    if (row["sweep"] == sweep && row["knob"] == knob && row["value"] == value) return row;
  throw std::runtime_error("no row " + sweep + " " + knob + " " + value);
}

inline double rmsOf(const Json& json, const std::string& preset) {
  return rowOf(json, "preset", "preset", preset)["errors"]["rms_db"].get<double>();
}

}  // namespace echocine::support
