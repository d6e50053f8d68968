// A scene that works, read to SI numbers.

#include "scene/scene_reader.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "scene/scene_json.h"
#include "support/scene_text.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;

// The one place where other units than SI exist.
TEST(SceneReader, TurnsEveryUnitIntoSI) {
  SceneText text = SceneText::oneBox("blood");
  text.probe = {{"apex", "[1, 2, -6.5]"}, {"axis", "[0, 0, 2]"}, {"lateral", "[3, 0, 1]"},
                {"sector_deg", "90"},     {"min_depth_mm", "5"}, {"depth_mm", "155"},
                {"frequency_mhz", "3.5"}, {"lines", "7"},        {"samples", "9"},
                {"aperture_mm", "12"},    {"focus_mm", "70"}};
  text.acquisition = {{"heart_rate_bpm", "90"}, {"frame_rate_hz", "25"}, {"beats", "2"}};
  text.extra = "";
  const Scene scene = parsed(text);
  EXPECT_DOUBLE_EQ(scene.probe.pose.origin.z, -0.065);
  EXPECT_DOUBLE_EQ(scene.probe.last_angle_rad, std::numbers::pi / 4);
  EXPECT_DOUBLE_EQ(scene.probe.min_depth_m, 0.005);
  EXPECT_DOUBLE_EQ(scene.probe.max_depth_m, 0.155);
  EXPECT_DOUBLE_EQ(scene.probe.frequency_hz, 3.5e6);
  EXPECT_DOUBLE_EQ(scene.probe.aperture_m, 0.012);
  EXPECT_DOUBLE_EQ(scene.probe.focus_m, 0.07);
  EXPECT_EQ(scene.probe.lines, 7);
  EXPECT_EQ(scene.probe.samples, 9);
  EXPECT_DOUBLE_EQ(scene.acquisition.heart_rate_hz, 1.5);
  EXPECT_EQ(scene.acquisition.beats, 2);
  EXPECT_EQ(scene.motion.mesh_unit_m, 0.01);
  EXPECT_DOUBLE_EQ(scene.unit_volume_m3, 1e-6);
}

TEST(SceneReader, ADirectionMayHaveAnyLengthButZero) {
  SceneText text = SceneText::oneBox("blood");
  const Pose pose = parsed(text).probe.pose;
  for (const char* size : {"e-320", "e-200", "e-7", "e7", "e200", "e308"}) {
    text.setProbe("axis", std::string("[0, 0, 1") + size + "]");
    text.setProbe("lateral", std::string("[1") + size + ", 0, 0]");
    const Pose scaled = parsed(text).probe.pose;
    EXPECT_LT(length(scaled.z_axis - pose.z_axis), 1e-15) << size;
    EXPECT_LT(length(scaled.x_axis - pose.x_axis), 1e-15) << size;
  }
}

TEST(SceneReader, ReadsHowBeatsDifferFromTheKeyframesAndFromEachOther) {
  const Scene plain = parsed(SceneText::oneBox("blood"));
  EXPECT_EQ(plain.acquisition.time_warp, WarpChoice::automatic);
  EXPECT_EQ(plain.acquisition.rr_variability, 0);
  EXPECT_EQ(plain.acquisition.seed, 1);
  EXPECT_FALSE(plain.motion.keyframe_heart_rate_hz || plain.motion.end_systole_phase);
  SceneText text = SceneText::oneBox("blood");
  text.acquisition["time_warp"] = "\"systole\"";
  text.acquisition["rr_variability"] = "0.3";
  text.acquisition["seed"] = "2147483647";
  text.motion["keyframe_heart_rate_bpm"] = "72";
  text.motion["end_systole_phase"] = "0.36";
  const Scene scene = parsed(text);
  EXPECT_EQ(scene.acquisition.time_warp, WarpChoice::systole);
  EXPECT_EQ(scene.acquisition.rr_variability, 0.3);
  EXPECT_EQ(scene.acquisition.seed, 2147483647);
  EXPECT_DOUBLE_EQ(*scene.motion.keyframe_heart_rate_hz, 1.2);
  EXPECT_EQ(scene.motion.end_systole_phase, 0.36);
  const auto json = sceneJson(scene);
  EXPECT_EQ(json["acquisition"]["time_warp"], "systole");
  EXPECT_EQ(json["acquisition"]["seed"], 2147483647);
  EXPECT_EQ(json["acquisition"]["rr_variability"], 0.3);
  EXPECT_EQ(json["motion"]["keyframe_heart_rate_hz"], 1.2);
  EXPECT_EQ(json["motion"]["end_systole_phase"], 0.36);
  EXPECT_TRUE(sceneJson(plain)["motion"]["end_systole_phase"].is_null());
}

TEST(SceneReader, ResolvesAMediumAtTheProbesFrequency) {
  SceneText text = SceneText::oneBox("jelly");
  text.setProbe("frequency_mhz", "4");
  text.media =
      "[media.jelly]\ndensity_kg_m3 = 1010\nsound_speed_m_s = 1490\nattenuation_db_cm_mhz = 0.3\n"
      "attenuation_exponent = 1.5\nbackscatter = { kind = \"fixed\", per_cm_sr = 2e-4 }\n";
  const Scene scene = parsed(text);
  const Medium& jelly = scene.medium(scene.structures[0].medium);
  EXPECT_EQ(jelly.name, "jelly");
  EXPECT_DOUBLE_EQ(jelly.impedance_kg_m2_s, 1010 * 1490.0);
  EXPECT_NEAR(jelly.attenuation_np_per_m, 0.3 * 8 * 100 / 8.685889638065037, 1e-10);
  EXPECT_DOUBLE_EQ(jelly.backscatter_per_m_sr, 0.02);
}

TEST(SceneReader, ASceneMayReplaceABuiltInMedium) {
  SceneText text = SceneText::oneBox("blood");
  text.media =
      "[media.blood]\ndensity_kg_m3 = 999\nsound_speed_m_s = 1000\nattenuation_db_cm_mhz = 0\n"
      "backscatter = { kind = \"none\" }\n";
  EXPECT_DOUBLE_EQ(parsed(text).media[1].impedance_kg_m2_s, 999000);
}

TEST(SceneReader, OneMediumOfTwoStructuresIsOneMedium) {
  SceneText text = SceneText::oneBox("blood");
  text.addStructure("other", "blood", "\"other.obj\"");
  text.addStructure("third", "soft_tissue", "\"third.obj\"");
  const Scene scene = parsed(text);
  EXPECT_EQ(scene.media.size(), 2u);
  EXPECT_EQ(scene.structures[0].medium, scene.structures[1].medium);
  EXPECT_EQ(scene.structures[2].medium, scene.background);
}

// lv_10 comes after lv_9, though not by letters.
TEST(SceneReader, KeyframesOfAPatternAreSortedByTheirNumbersAndEvenlySpaced) {
  const TempFolder folder;
  for (const char* name : {"lv_10.obj", "lv_9.obj", "lv_1.obj", "lv_2.obj", "la_1.obj"})
    folder.write(name, "");
  SceneText text;
  text.addStructure("lv", "blood", "\"lv_*.obj\"");
  const Scene scene = parseScene(text.text(), folder / "scene.toml");
  const std::vector<Keyframe>& k = scene.structures[0].keyframes;
  ASSERT_EQ(k.size(), 4u);
  EXPECT_EQ(k[0].files[0], folder / "lv_1.obj");
  EXPECT_EQ(k[1].files[0], folder / "lv_2.obj");
  EXPECT_EQ(k[2].files[0], folder / "lv_9.obj");
  EXPECT_EQ(k[3].files[0], folder / "lv_10.obj");
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(k[i].phase, 0.25 * static_cast<double>(i));
}

TEST(SceneReader, KeyframesWithPhasesKeepThem) {
  SceneText text;
  text.addStructure("lv", "blood",
                    "[{ file = \"a.obj\", phase = 0.1 }, { file = \"/b.obj\", phase = 0.7 }]");
  const std::vector<Keyframe> k =
      parseScene(text.text(), "folder/scene.toml").structures[0].keyframes;
  ASSERT_EQ(k.size(), 2u);
  EXPECT_EQ(k[0].phase, 0.1);
  EXPECT_EQ(k[0].files[0], "folder/a.obj");
  EXPECT_EQ(k[1].files[0], "/b.obj");
}

TEST(SceneReader, LidsJoinTheirKeyframes) {
  SceneText text;
  text.addStructure("lv", "blood", "[\"a.obj\", \"b.obj\"]", 1, "lids = \"lid.obj\"");
  EXPECT_NE(refusalOf(text.text()), "");
  text.structures.clear();
  text.addStructure("lv", "blood", "[\"a.obj\"]", 1, "lids = [\"mitral.obj\", \"aortic.obj\"]");
  EXPECT_EQ(parsed(text).structures[0].keyframes[0].files.size(), 3u);
}

TEST(SceneReader, LeftOutTablesTakeTheirDefaults) {
  SceneText text = SceneText::oneBox("blood");
  text.acquisition.clear();
  text.motion.clear();
  text.output.clear();
  const Scene scene = parsed(text), defaults;
  EXPECT_EQ(scene.acquisition.frame_rate_hz, defaults.acquisition.frame_rate_hz);
  EXPECT_EQ(scene.motion.mesh_unit_m, defaults.motion.mesh_unit_m);
  EXPECT_EQ(scene.output.width, defaults.output.width);
  EXPECT_EQ(scene.signal.dynamic_range_db, defaults.signal.dynamic_range_db);
  EXPECT_EQ(scene.effects.refraction, Switch::automatic);
}

TEST(SceneReader, ChannelsAreThoseAskedForOnceEach) {
  SceneText text = SceneText::oneBox("blood");
  text.output["channels"] = "[\"medium.id\", \"Y\", \"Y\", \"reflection.Y\"]";
  const std::vector<Channel> channels = parsed(text).output.channels;
  EXPECT_EQ(channels.size(), 3u);
  for (const Channel c : {Channel::y, Channel::reflection, Channel::medium})
    EXPECT_NE(std::find(channels.begin(), channels.end(), c), channels.end());
}

}  // namespace
}  // namespace echocine
