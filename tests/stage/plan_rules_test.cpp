// What the plan finds out from the meshes: when rays have to bend, and the mean time gain.

#include <gtest/gtest.h>

#include "core/units.h"
#include "motion/mesh_motion.h"
#include "simulate/mean_loss.h"
#include "simulate/plan_loop.h"
#include "support/loop_scene.h"

namespace echocine {
namespace {

using namespace support;

const std::string kMedia =
    "[media.tissue]\ndensity_kg_m3 = 1060\nsound_speed_m_s = 1584\nattenuation_db_cm_mhz = 0.5\n"
    "backscatter = { kind = \"fixed\", per_cm_sr = 1e-5 }\n"
    "[media.lens]\ndensity_kg_m3 = 1060\nsound_speed_m_s = 1450\nattenuation_db_cm_mhz = 0.5\n"
    "backscatter = { kind = \"fixed\", per_cm_sr = 1e-5 }\n"
    "[media.plaque]\ndensity_kg_m3 = 1200\nsound_speed_m_s = 1584\nattenuation_db_cm_mhz = 15\n"
    "backscatter = { kind = \"fixed\", per_cm_sr = 1e-5 }\n"
    "[media.wall]\ndensity_kg_m3 = 1200\nsound_speed_m_s = 1584\nattenuation_db_cm_mhz = 0.5\n"
    "backscatter = { kind = \"fixed\", per_cm_sr = 1e-5 }\n";

// A ball of `medium` and a wall behind it.
SceneText ballAndWall(const TempFolder& folder, const std::string& medium,
                      const std::string& keyframes = "\"ball.obj\"") {
  writeObj(icosphere(3, 1.5).moved({0.4, 0.1, 5}), folder / "ball.obj");
  writeObj(icosphere(3, 1.5).moved({0.4, 12, 5}), folder / "ball_away.obj");
  writeObj(box({-9, -4, 9}, {9, 4, 11}), folder / "wall.obj");
  SceneText text;
  text.background = "tissue";
  text.media = kMedia;
  text.probe["lines"] = "64";
  text.addStructure("wall", "wall", "\"wall.obj\"", 1);
  text.addStructure("ball", medium, keyframes, 2);
  return text;
}

LoopPlan planOf(const TempFolder& folder, const SceneText& text) {
  const Scene scene = readScene(folder.write("scene.toml", text.text()));
  return planLoop(scene, MeshMotion(scene));
}

TEST(RefractionRule, FindsALensThatIsInViewAtOneKeyframeAlone) {
  const TempFolder folder;
  std::string keyframes = "[";
  for (const char* phase : {"0.0", "0.2", "0.45", "0.6", "0.65", "0.7", "0.85"})
    keyframes += std::string("{ file = \"") +
                 (std::string(phase) == "0.65" ? "ball.obj" : "ball_away.obj") +
                 "\", phase = " + phase + " },\n";
  SceneText text = ballAndWall(folder, "lens", keyframes + "]");
  text.motion["interpolation"] = "\"linear\"";
  const LoopPlan plan = planOf(folder, text);
  EXPECT_TRUE(plan.effects.refraction);
  EXPECT_NE(plan.effects.decision(Effect::refraction).reason.find("phase 0.65"), std::string::npos)
      << plan.effects.decision(Effect::refraction).reason;
}

TEST(RefractionRule, DoesNotDependOnTheNumberOfLines) {
  const TempFolder folder;
  SceneText text = ballAndWall(folder, "lens");
  const std::string reason = planOf(folder, text).effects.decision(Effect::refraction).reason;
  text.probe["lines"] = "560";
  EXPECT_EQ(planOf(folder, text).effects.decision(Effect::refraction).reason, reason);
}

// Many echoes that stay where they are do not hide those that move.
TEST(RefractionRule, LayersRoundTheTransducerHideNoLens) {
  const TempFolder folder;
  SceneText text = ballAndWall(folder, "lens");
  for (int i = 0; i < 24; ++i) {
    const std::string name = "shell_" + std::to_string(i);
    writeObj(icosphere(3, 2.4 + 0.04 * i), folder / (name + ".obj"));
    text.addStructure(name, i % 2 == 0 ? "wall" : "tissue", "\"" + name + ".obj\"", -1 - i);
  }
  EXPECT_TRUE(planOf(folder, text).effects.refraction);
}

// A cylinder along the lines: what stays in the imaging plane meets it head-on.
TEST(RefractionRule, AsksRaysOutOfTheImagingPlaneToo) {
  const TempFolder folder;
  SceneText text = ballAndWall(folder, "lens");
  Mesh cylinder = icosphere(4, 0.8);
  for (Vec3d& p : cylinder.points) p.x *= 20;
  writeObj(cylinder.moved({0, 0, 5}), folder / "ball.obj");
  text.probe["sector_deg"] = "6";
  EXPECT_FALSE(planOf(folder, text).effects.refraction);
  text.accuracy["rays_per_beam"] = "64";
  EXPECT_TRUE(planOf(folder, text).effects.refraction);
  text.effects["elevation"] = "\"off\"";
  EXPECT_FALSE(planOf(folder, text).effects.refraction);
}

TEST(RefractionRule, AskedForWhereNoSpeedDiffersItChangesNothing) {
  const TempFolder folder;
  SceneText text = ballAndWall(folder, "plaque");
  text.effects["refraction"] = "\"on\"";
  const LoopPlan plan = planOf(folder, text);
  EXPECT_FALSE(plan.effects.refraction);
  EXPECT_TRUE(plan.slice && plan.cell_echoes);
}

TEST(BentRays, TakeSmoothNormalsWhereSurfacesHaveThem) {
  const TempFolder folder;
  SceneText text = ballAndWall(folder, "lens");
  text.motion["subdivision"] = "1";
  EXPECT_TRUE(planOf(folder, text).smooth_normals);
  text.effects["refraction"] = "\"off\"";
  EXPECT_FALSE(planOf(folder, text).smooth_normals);
}

// exp(-4 alpha z) of one attenuation everywhere.
TEST(MeanGain, OfOneAttenuationIsThatOfThePaper) {
  const TempFolder folder;
  SceneText text = ballAndWall(folder, "lens");
  text.signal["tgc"] = "\"mean\"";
  const LoopPlan plan = planOf(folder, text);
  const Scene scene = readScene(folder / "scene.toml");
  const double alpha = scene.medium(scene.background).attenuation_np_per_m;
  ASSERT_EQ(plan.effects.mean_loss.size(), 64u);
  for (int k = 0; k < 64; ++k) {
    const double z = scene.probe.min_depth_m + (k + 0.5) * scene.probe.sampleSpacing();
    EXPECT_NEAR(plan.effects.mean_loss[static_cast<std::size_t>(k)] / std::exp(-4 * alpha * z), 1,
                1e-5);
  }
}

// The ball takes more than all around it: the curve lies between both, and never rises.
TEST(MeanGain, OfAPlaqueLiesBetweenTheLinesBesideAndBehindIt) {
  const TempFolder folder;
  SceneText text = ballAndWall(folder, "plaque");
  text.signal["tgc"] = "\"mean\"";
  const std::vector<double> loss = planOf(folder, text).effects.mean_loss;
  const Scene scene = readScene(folder / "scene.toml");
  const double alpha = scene.medium(scene.background).attenuation_np_per_m;
  for (std::size_t k = 1; k < loss.size(); ++k) EXPECT_LE(loss[k], loss[k - 1]);
  const double z = scene.probe.min_depth_m + 50.5 * scene.probe.sampleSpacing();
  const double beside = std::exp(-4 * alpha * z);
  // The ball spans 35 of 70 degrees; behind it hardly anything is left.
  EXPECT_LT(loss[50], 0.8 * beside);
  EXPECT_GT(loss[50], 0.4 * beside);
}

TEST(MeanGain, ThePaperIsTheDefault) {
  const TempFolder folder;
  EXPECT_TRUE(planOf(folder, ballAndWall(folder, "plaque")).effects.mean_loss.empty());
}

// Walls are filled, so one without its chamber hides blood.
TEST(PlanWarnings, AWallWithoutItsChamberIsTold) {
  const TempFolder folder;
  SceneText text = ballAndWall(folder, "plaque");
  const auto told = [&] {
    for (const std::string& warning : planOf(folder, text).warnings)
      if (warning.find("no structure is lv_cavity") != std::string::npos) return true;
    return false;
  };
  text.addStructure("muscle", "wall", "\"ball.obj\"", 3, "role = \"lv_wall\"");
  EXPECT_FALSE(told());  // no heart's wall
  text.addStructure("beside", "lens", "\"ball_away.obj\"", 4, "role = \"rv_cavity\"");
  EXPECT_TRUE(told());
  text.addStructure("chamber", "lens", "\"ball.obj\"", 4, "role = \"lv_cavity\"");
  EXPECT_FALSE(told());
}

}  // namespace
}  // namespace echocine
