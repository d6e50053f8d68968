// From a doubtful scene to standard error and the manifest; and the judgement of interpolations.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "support/loop_scene.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

class Warnings : public ::testing::Test {
 protected:
  Warnings() { writeBallMeshes(folder); }
  Outcome run(const std::string& command, const SceneText& text, const std::string& more = "") {
    const std::string scene = folder.write("scene.toml", text.text()).string();
    return runShell("%B " + command + " '" + scene + "' " + more);
  }
  std::string out() const { return "-o '" + (folder / "out").string() + "'"; }
  nlohmann::json manifest() const {
    return nlohmann::json::parse(bytesOf(folder / "out/manifest.json"));
  }
  // In keyframe 3 a vertex of the cavity has slid over its neighbours, 0.7 cm away. Straight blends
  // keep the volume between its keyframes', so that this alone is told.
  SceneText slipped() {
    Mesh mesh = icosphere(2, 2.5);
    const Vec3d p = mesh.points[0], along = normalised(cross(p, Vec3d{0, 0, 1}));
    mesh.points[0] = 2.5 * normalised(p + 1.3 * along);
    writeObj(mesh.moved({0.3, 0.2, 6}), folder / "cavity_3.obj");
    SceneText text = ballScene(50);
    text.motion["interpolation"] = "\"linear\"";
    return text;
  }
  TempFolder folder;
};

TEST_F(Warnings, ATurnedTriangleIsOneLineAndStandsInTheManifest) {
  const SceneText scene = slipped();
  const Outcome outcome = run("render", scene, out());
  EXPECT_EQ(outcome.code, 0);
  const nlohmann::json warnings = manifest().at("warnings");
  ASSERT_EQ(warnings.size(), 1u);
  const std::string warning = warnings[0].get<std::string>();
  for (const char* part : {"structure.keyframes: cavity: frame ", "cavity_2.obj: face ",
                           "cavity_3.obj; it is folded in one of the two"})
    EXPECT_NE(warning.find(part), std::string::npos) << warning;
  // On the terminal files have their folders, in the manifest none.
  std::string told = outcome.err;
  const std::string folders = folder.path().string() + "/";
  for (std::size_t at = 0; (at = told.find(folders)) != std::string::npos;)
    told.erase(at, folders.size());
  EXPECT_NE(told.find("echocine: warning: " + warning + "\n"), std::string::npos) << outcome.err;
  EXPECT_EQ(warning.find(folders), std::string::npos) << warning;
}

// But for that nothing can be seen, see PlanCommand.
TEST_F(Warnings, QuietKeepsThemInTheManifestOnly) {
  const SceneText scene = slipped();
  const Outcome outcome = run("render", scene, out() + " --quiet");
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(manifest().at("warnings").size(), 1u);
}

TEST_F(Warnings, AWholeLoopHasNone) {
  const Outcome outcome = run("render", ballScene(20), out());
  EXPECT_EQ(outcome.err.find("warning"), std::string::npos) << outcome.err;
  EXPECT_TRUE(manifest().at("warnings").empty());
}

TEST_F(Warnings, PlanShowsThemToo) {
  const SceneText scene = slipped();
  const Outcome plan = run("plan", scene);
  EXPECT_EQ(plan.code, 0);
  EXPECT_NE(plan.err.find("echocine: warning: "), std::string::npos) << plan.err;
  const nlohmann::json json = nlohmann::json::parse(run("plan", scene, "--json").out);
  EXPECT_EQ(json.at("warnings").size(), 1u);
}

TEST_F(Warnings, ASceneIsDoubtedBeforeItsMeshesAreRefused) {
  for (int i = 0; i < 8; ++i)
    writeObj(icosphere(1, 3.0), folder / ("wall_x_" + std::to_string(i) + ".obj"));
  SceneText text = ballScene(5);
  text.addStructure("wall_x", "blood", "\"wall_x_*.obj\"", 3);
  const Outcome outcome = run("render", text, out());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("warning: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("wall: its 16 keyframes include all 8 of structure wall_x"),
            std::string::npos)
      << outcome.err;
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Warnings, InsideOutIsCodeOneAndWritesNothing) {
  SceneText text = ballScene(48);
  text.motion["interpolation"] = "\"catmull-rom\"";  // straight blends never turn
  text.structures.clear();
  text.addStructure("cavity", "blood", "\"beat_*.obj\"");
  for (int i = 0; i < 4; ++i)
    writeObj(icosphere(1, i < 2 ? 2.5 : 0.06).moved({0.3, 0.2, 6}),
             folder / ("beat_" + std::to_string(i) + ".obj"));
  for (const std::string& command : {std::string("render"), std::string("plan")}) {
    const Outcome outcome =
        run(command, text, (command == "render" ? out() : "") + std::string(" --quiet"));
    EXPECT_EQ(outcome.code, 1);
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const char* part : {"scene.toml:", "structure.keyframes: cavity: frame ", "encloses -",
                             "beat_2.obj and ", "it is inverted in between"})
      EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " in " << outcome.err;
  }
  EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Warnings, InterpolationsAreJudgedOnTheScenesOwnKeyframes) {
  const Outcome table = run("plan", ballScene(5), "--interpolation");
  EXPECT_EQ(table.code, 0) << table.err;
  for (const char* word : {"linear", "catmull-rom", "spline", "fourier", "cavity", "all", "mm"})
    EXPECT_NE(table.out.find(word), std::string::npos) << word << " in\n" << table.out;
  const nlohmann::json json =
      nlohmann::json::parse(run("plan", ballScene(5), "--interpolation --json").out);
  EXPECT_FALSE(json.contains("leaflet"));  // still
  // The radius is a cosine at eight keyframes; of every other one linear keeps the mean.
  const nlohmann::json& cavity = json.at("cavity");
  EXPECT_NEAR(cavity.at("linear").at("vertex_rms_mm").get<double>(),
              25 * 0.15 * (1 - std::cos(std::numbers::pi / 4)) * std::cos(std::numbers::pi / 4),
              1e-4);
  EXPECT_LT(cavity.at("fourier").at("vertex_rms_mm").get<double>(), 1e-4);
  EXPECT_NEAR(json.at("wall").at("spline").at("volume_max_ml").get<double>(), 0, 1e-3);
}

TEST_F(Warnings, TooFewKeyframesToJudgeIsNamed) {
  SceneText text = ballScene(5);
  text.structures.clear();
  text.addStructure("wall", "blood", "\"wall_0.obj\"");
  const Outcome outcome = run("plan", text, "--interpolation --quiet");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("structure.keyframes: too few keyframes to omit some, accepted: "
                             "four or more"),
            std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace echocine
