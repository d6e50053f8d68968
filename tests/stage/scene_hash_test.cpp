// The hash by which a run knows frames of an earlier one.

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <set>

#include "motion/surfaces/mesh_motion.h"
#include "render/render_pass.h"
#include "support/key_scene.h"
#include "support/loop_scene.h"

namespace echocine {
namespace {

using namespace support;

// Values for keys that are no single member of a scene.
std::optional<std::pair<std::string, std::string>> twoValuesOf(const std::string& name) {
  static const std::map<std::string, std::pair<std::string, std::string>> kHashedValues{
      {"background", {"\"blood\"", "\"soft_tissue\""}},
      {"probe.apex", {"[0, 0, 0]", "[0, 0, 1]"}},
      {"probe.axis", {"[0, 0, 1]", "[0, 1, 1]"}},
      {"probe.lateral", {"[1, 0, 0]", "[1, 1, 0]"}},
      {"probe.view", {"\"a4c\"", "\"a2c\""}},
      {"probe.shift_mm", {"[0, 0, 0]", "[0, 1, 0]"}},
      {"motion.mesh_offset_mm", {"[0, 0, 0]", "[0, 1, 0]"}},
      {"motion.keyframe_interval_ms", {"400", "401"}},
      {"motion.keyframe_phases", {"[0, 0.4]", "[0, 0.41]"}},
      {"structure.name", {"\"ball\"", "\"bull\""}},
      {"structure.medium", {"\"own\"", "\"blood\""}},
      {"structure.keyframes", {"[\"a.obj\", \"b.obj\"]", "[\"a.obj\", \"c.obj\"]"}},
      {"structure.lids", {"[]", "\"l.obj\""}},
      {"structure.repair", {"[\"weld\"]", "[\"orient\"]"}},
      {"media.density_kg_m3", {"1000", "1001"}},
      {"media.sound_speed_m_s", {"1500", "1501"}},
      {"media.attenuation_db_cm_mhz", {"0.5", "0.6"}},
      {"media.attenuation_exponent", {"1", "1.1"}},
      {"media.blood", {"true", "false"}},
      {"media.backscatter.kind", {"\"none\"", "\"fixed\"\nper_cm_sr = 1e-4"}},
      {"media.backscatter.per_cm_sr", {"1e-4", "2e-4"}},
      {"media.backscatter.velocity_variation", {"0.01", "0.02"}},
      {"media.backscatter.correlation_length_um", {"50", "60"}},
      {"media.backscatter.hematocrit", {"0.4", "0.3"}},
      {"media.backscatter.cell_radius_um", {"2.75", "3"}},
      {"media.backscatter.cell_density_kg_m3", {"1099", "1100"}},
      {"media.backscatter.cell_compressibility_cm2_dyn", {"3.4e-11", "3.5e-11"}},
      {"media.backscatter.plasma", {"\"plasma\"", "\"soft_tissue\""}},
      {"truth.write", {"[\"labels\"]", "[\"contours\"]"}},
      {"truth.labels", {"{ ball = 1 }", "{ ball = 2 }"}},
      {"signal.tgc_table_mm_db", {"[[0, 0]]", "[[0, 1]]"}},
      {"output.channels", {"[\"Y\"]", "[\"Y\", \"medium.id\"]"}},
  };
  const auto found = kHashedValues.find(name);
  if (found == kHashedValues.end()) return std::nullopt;
  return found->second;
}

// Scenes that differ in one key, by its values in a file.
std::vector<Scene> scenesOf(const SceneKey& key, const std::pair<std::string, std::string>& two) {
  std::vector<Scene> scenes;
  for (const std::string& value : {two.first, two.second}) {
    KeyScene text(key);
    if (!value.empty()) text.set(key.fullName(), value);
    scenes.push_back(text.scene());
  }
  return scenes;
}

// By the values of its member: every word, or both ends of its range.
std::vector<Scene> scenesOf(const SceneKey& key) {
  std::vector<KeyValue> values{true, false};
  if (key.field.kind == KeyKind::word) {
    values.clear();
    for (const std::string_view word : key.field.words()) values.emplace_back(std::string(word));
  } else if (isNumber(key)) {
    const double low = key.range.lo_open ? 1 : key.range.lo,
                 high = std::isfinite(key.range.hi) ? key.range.hi : 1;
    values = {inCode(key, key.unit.to_si(low)), inCode(key, key.unit.to_si(high))};
  }
  KeyScene text(key);
  for (const char* needed : {"probe.width_mm", "probe.face_radius_mm", "signal.beam_width_mm"})
    if (key.fullName() == needed) text.set(needed, "30");
  std::vector<Scene> scenes(values.size(), text.scene());
  for (std::size_t i = 0; i < values.size(); ++i) key.field.set(ownerOf(scenes[i]), values[i]);
  return scenes;
}

// What --resume trusts: frames are taken over where the hash is the same. tolerance_db is left out:
// it chooses values of other keys, and these are in the hash.
TEST(SceneHash, EveryKeyChangesIt) {
  const TempFolder folder;
  const MeshMotion motion(readScene(writeBall(folder, ballScene(5))));
  for (const SceneKey& key : sceneKeys()) {
    const std::string name = key.fullName();
    if (name == "accuracy.tolerance_db") continue;
    const auto two = twoValuesOf(name);
    ASSERT_TRUE(two || key.field.get) << name << " needs two values above";
    const std::vector<Scene> scenes = two ? scenesOf(key, *two) : scenesOf(key);
    std::set<std::string> hashes;
    for (const Scene& scene : scenes) hashes.insert(sceneSha256(scene, motion));
    EXPECT_EQ(hashes.size(), scenes.size()) << name;
  }
}

}  // namespace
}  // namespace echocine
