// echocine plan, demands that exclude each other, and scenes in which nothing can be seen.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "support/loop_scene.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;

class PlanCommand : public ::testing::Test {
 protected:
  PlanCommand() { writeBallMeshes(folder); }
  std::filesystem::path write(const SceneText& text) {
    return folder.write("scene.toml", text.text());
  }
  TempFolder folder;
};

TEST_F(PlanCommand, TellsEffectsTracerTrianglesTimeAndMemory) {
  const Outcome outcome = runShell("%B plan '" + write(ballScene(4)).string() + "'");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* word :
       {"reflection", "refraction", "beam_width", "tracer", "triangles", "time", "memory"})
    EXPECT_NE(outcome.out.find(word), std::string::npos) << word << " in\n" << outcome.out;
}

TEST_F(PlanCommand, AsJson) {
  const Outcome outcome = runShell("%B plan --json '" + write(ballScene(4)).string() + "'");
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["frames"], 4);
  EXPECT_GT(json["effects"].size(), 10u);
  EXPECT_GT(json["seconds"], 0);
  EXPECT_GT(json["memory_bytes"], 0);
  double shares = 0;
  for (const auto& e : json["effects"]) shares += e["time_share"].get<double>();
  EXPECT_GT(shares, 0);
  EXPECT_LE(shares, 1);
}

TEST_F(PlanCommand, SaysHowManyRaysABeamHasAndWhatTheySpreadOver) {
  SceneText text = ballScene(2);
  text.accuracy["rays_per_beam"] = "6";
  const Outcome outcome = runShell("%B plan --json '" + write(text).string() + "'");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const nlohmann::json json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["tracer"], "embree");
  EXPECT_EQ(json["rays_per_beam"], 6);
  EXPECT_EQ(json["interface_echo"], "centre");
  for (const auto& e : json["effects"])
    if (e["name"] == "elevation" || e["name"] == "beam_width") {
      EXPECT_TRUE(e["on"]) << e;
      EXPECT_NE(e["reason"].get<std::string>().find("6 rays"), std::string::npos) << e;
    }
}

struct Contradiction {
  const char *table, *key, *value, *table2, *key2, *value2;
};

TEST_F(PlanCommand, ContradictionsAreOneLineThatNamesBothKeys) {
  for (const Contradiction& c :
       {Contradiction{"effects", "refraction", "\"on\"", "accuracy", "tracer", "\"slice\""},
        Contradiction{"output", "channels", "[\"Y\"]", "effects", "attenuation", "\"off\""},
        Contradiction{"accuracy", "tracer", "\"slice\"", "accuracy", "rays_per_beam", "8"},
        Contradiction{"accuracy", "interface_echo", "\"cell\"", "accuracy", "rays_per_beam", "8"},
        Contradiction{"signal", "beam_width", "\"fixed\"\nbeam_width_mm = 2", "accuracy",
                      "rays_per_beam", "8"},
        Contradiction{"effects", "elevation", "\"on\"", "accuracy", "rays_per_beam", "1"},
        Contradiction{"accuracy", "elevation_slices", "3", "accuracy", "tracer", "\"embree\""},
        Contradiction{"accuracy", "elevation_slices", "3", "effects", "elevation", "\"off\""},
        Contradiction{"accuracy", "elevation_slices", "5", "effects", "refraction", "\"on\""}}) {
    SceneText text = ballScene(2);
    const auto lines = [&](std::string_view table) -> Lines& {
      return table == "effects"    ? text.effects
             : table == "accuracy" ? text.accuracy
             : table == "signal"   ? text.signal
                                   : text.output;
    };
    lines(c.table)[c.key] = c.value;
    lines(c.table2)[c.key2] = c.value2;
    const Outcome outcome = runShell("%B plan '" + write(text).string() + "'");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const char* key : {c.key, c.key2})
      EXPECT_NE(outcome.err.find(key), std::string::npos) << outcome.err;
  }
}

// A picture without its ticks and its ECG.
int brightest(const std::filesystem::path& png) {
  const cv::Mat image = cv::imread(png.string(), cv::IMREAD_GRAYSCALE);
  double most = -1;
  if (!image.empty()) cv::minMaxLoc(image, nullptr, &most);
  return static_cast<int>(most);
}

void expectBlackWithWarning(TempFolder& folder, SceneText text) {
  text.output["png"] = "true";
  text.output["ecg"] = "false";
  text.output["depth_ticks"] = "false";
  const std::string scene = folder.write("scene.toml", text.text()).string();
  const Outcome outcome =
      runShell("%B render '" + scene + "' -o '" + (folder / "out").string() + "'");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: nothing can be seen"), std::string::npos) << outcome.err;
  const Outcome quiet = runShell("%B plan '" + scene + "' --quiet");
  EXPECT_TRUE(quiet.err.starts_with("echocine: warning: nothing can be seen")) << quiet.err;
  EXPECT_EQ(brightest(folder / "out/png/frame_0001.png"), 0);
}

TEST_F(PlanCommand, AProbeThatLooksAwayWarnsAndRendersBlack) {
  SceneText text = ballScene(2);
  text.setProbe("axis", "[0, 0, -1]");
  expectBlackWithWarning(folder, text);
}

TEST_F(PlanCommand, EverythingInOneMediumWarnsAndRendersBlack) {
  SceneText text = ballScene(2);
  text.structures.clear();
  text.addStructure("wall", "soft_tissue", "\"wall_*.obj\"");
  expectBlackWithWarning(folder, text);
}

}  // namespace
}  // namespace echocine
