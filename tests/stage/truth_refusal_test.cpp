// What truth cannot be told of: one line that names the key and what would do.

#include <gtest/gtest.h>

#include <algorithm>

#include "frame/simulator.h"
#include "support/scene_text.h"

namespace echocine {
namespace {

using support::SceneText;

std::shared_ptr<const TriangleMesh> ball(double radius_mm, Vec3d middle_mm) {
  const support::Mesh mesh = support::icosphere(3, radius_mm).moved(middle_mm);
  return std::make_shared<TriangleMesh>(TriangleMesh{mesh.points, mesh.triangles, {}, {}});
}

// A ventricle in its wall; `roles` are those of the outer and the inner ball.
SceneText ventricle(const std::string& truth, const std::string& outer = "lv_wall",
                    const std::string& inner = "lv_cavity") {
  SceneText text;
  text.motion = {{"mesh_unit", "\"mm\""}};
  text.addStructure("outer", "myocardium", "\"outer\"", 1, "role = \"" + outer + "\"");
  text.addStructure("inner", "blood", "\"inner\"", 2, "role = \"" + inner + "\"");
  text.extra = "[truth]\n" + truth + "\n";
  return text;
}

// What is said on the way to the first frame's truth; empty when it is there.
std::string truthRefusalOf(const SceneText& text, Vec3d middle_mm = {0, 0, 60},
                           double inner_mm = 20) {
  const NamedMeshes meshes{{"outer", ball(30, middle_mm)}, {"inner", ball(inner_mm, middle_mm)}};
  try {
    const Simulator simulator(parseScene(text.text(), "scene.toml", meshes));
    return simulator.truth() != nullptr ? "" : "none was requested";
  } catch (const SceneError& error) {
    return error.what();
  }
}

void expectNames(const std::string& refusal, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    EXPECT_NE(refusal.find(word), std::string::npos) << word << " in: " << refusal;
  EXPECT_EQ(refusal.find('\n'), std::string::npos);
}

TEST(TruthRefusal, WhatCanBeToldIs) {
  EXPECT_EQ(truthRefusalOf(ventricle("write = [\"all\"]\nlabels = {lv_cavity = 1, lv_wall = 2}")),
            "");
  EXPECT_EQ(truthRefusalOf(ventricle("")), "none was requested");
}

// What the scene has is given, the rest is named by a warning; kinds by name are refused as ever.
TEST(TruthRefusal, AllIsWhatTheSceneHas) {
  const NamedMeshes meshes{{"outer", ball(30, {0, 0, 60})}, {"inner", ball(20, {0, 0, 60})}};
  const Scene scene =
      parseScene(ventricle("write = [\"all\"]", "rv_wall").text(), "scene.toml", meshes);
  const auto told = std::count_if(
      scene.warnings.begin(), scene.warnings.end(),
      [](const std::string& w) { return w.find("omits tracks") != std::string::npos; });
  ASSERT_EQ(told, 1);
  expectNames(scene.warnings[0], {"tracks", "function", "lv_wall"});
  EXPECT_EQ(scene.warnings[0].find("lv_cavity"), std::string::npos);
  EXPECT_TRUE(scene.truth.labels && scene.truth.contours);
  EXPECT_FALSE(scene.truth.tracks || scene.truth.function);
  const Frame frame = Simulator(scene).frame(0);
  EXPECT_FALSE(frame.truth->labels.empty());
  EXPECT_EQ(frame.truth->contours.size(), 2u);
  EXPECT_FALSE(frame.truth->function);
  EXPECT_NE(truthRefusalOf(ventricle("write = [\"all\", \"tracks\"]", "rv_wall")), "");
}

TEST(TruthRefusal, LabelsOfARoleThatNothingHas) {
  expectNames(truthRefusalOf(ventricle("write = [\"labels\"]\nlabels = {la = 1}")),
              {"scene.toml", "labels", "la is not a closed structure"});
}

TEST(TruthRefusal, ANumberTwice) {
  expectNames(
      truthRefusalOf(ventricle("write = [\"labels\"]\nlabels = {lv_cavity = 3, lv_wall = 3}")),
      {"labels", "lv_cavity", "lv_wall", "number 3"});
}

TEST(TruthRefusal, FunctionWithoutAVentricleOrItsWall) {
  expectNames(truthRefusalOf(ventricle("write = [\"function\"]", "lv_wall", "rv_cavity")),
              {"write", "lv_cavity", "truth.write"});
  expectNames(truthRefusalOf(ventricle("write = [\"tracks\"]", "rv_wall")), {"write", "lv_wall"});
}

// The cavity fills the wall: there is nothing between them.
TEST(TruthRefusal, PointsInAWallThatIsEmpty) {
  expectNames(truthRefusalOf(ventricle("write = [\"tracks\"]"), {0, 0, 60}, 30),
              {"write", "outer"});
}

TEST(TruthRefusal, PointsOutsideTheSector) {
  expectNames(truthRefusalOf(ventricle("write = [\"tracks\"]"), {0, 0, -60}),
              {"tracks", "outer", "sector"});
}

}  // namespace
}  // namespace echocine
