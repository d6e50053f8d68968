// What the plan finds out from the meshes: when rays have to bend, and the mean time gain.

#include <gtest/gtest.h>

#include "core/units.h"
#include "frame/mean_loss.h"
#include "frame/plan_loop.h"
#include "frame/simulator.h"
#include "motion/surfaces/mesh_motion.h"
#include "scene/beam_profile.h"
#include "scene/scan_geometry.h"
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
    "[media.absorber]\ndensity_kg_m3 = 1060\nsound_speed_m_s = 1700\nattenuation_db_cm_mhz = 13\n"
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
  const MeshMotion motion(scene);
  const LoopPlan plan = planLoop(scene, motion),
                 silent = planLoop(scene, motion, PlanWords::without_warnings);
  EXPECT_EQ(silent.left_out, plan.left_out);
  EXPECT_EQ(silent.triangles_kept, plan.triangles_kept);
  EXPECT_EQ(silent.effects.refraction, plan.effects.refraction);
  EXPECT_EQ(silent.effects.mean_loss, plan.effects.mean_loss);
  EXPECT_EQ(silent.slice, plan.slice);
  EXPECT_EQ(silent.echo_reason, plan.echo_reason);
  EXPECT_TRUE(silent.warnings.empty());
  return plan;
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

// A slab at 50 degrees, which takes 120 dB from no straight ray and from every bent one: those go
// a longer way through it.
TEST(RefractionRule, FindsAShadowThatOnlyBentRaysCast) {
  const TempFolder folder;
  SceneText text = ballAndWall(folder, "absorber", "\"slab.obj\"");
  Mesh slab = box({-1.2, -3, 5}, {1.2, 3, 6.56});
  for (Vec3d& p : slab.points) p.z += std::tan(radiansFromDegrees(50)) * p.x;
  writeObj(slab, folder / "slab.obj");
  text.probe["sector_deg"] = "2";
  const LoopPlan plan = planOf(folder, text);
  EXPECT_TRUE(plan.effects.refraction) << plan.effects.decision(Effect::refraction).reason;
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

constexpr double kLeftToFew = 0.01;

// One frame of a loop: the medium of each sample, and whether the plan bends rays.
struct Labelled {
  Scene scene;
  bool bent = false;
  std::vector<std::uint32_t> medium;
};

Labelled labelledFrame(const TempFolder& folder, SceneText text,
                       std::initializer_list<const char*> effects, const char* wanted) {
  for (const char* effect : effects) text.effects[effect] = wanted;
  const Simulator simulator(readScene(folder.write("scene.toml", text.text())));
  return {simulator.scene(), simulator.plan().effects.refraction, simulator.frame(0).medium};
}

// The share of samples of `a` whose medium `b` shows nowhere within `widths` of the beam's width,
// or within one sample or line.
double shareFartherThan(const Labelled& a, const Labelled& b, double widths) {
  const Probe& probe = a.scene.probe;
  const double wavelength_m = ScanGeometry(probe).wavelength();
  std::size_t farther = 0;
  for (int line = 0; line < probe.lines; ++line)
    for (int k = 0; k < probe.samples; ++k) {
      const double depth_m = ScanGeometry(probe).sampleDepth(k);
      const double reach_m =
          widths * focusedBeamWidth(depth_m, probe.aperture_m, probe.focus_m, wavelength_m);
      const int lines = static_cast<int>(std::ceil(reach_m / lineSpacing(probe, depth_m)));
      const int samples = static_cast<int>(std::ceil(reach_m / probe.sampleSpacing()));
      const auto at = [&](int i, int j) {
        return static_cast<std::size_t>(i) * static_cast<std::size_t>(probe.samples) +
               static_cast<std::size_t>(j);
      };
      bool found = false;
      for (int i = std::max(line - lines, 0); i <= std::min(line + lines, probe.lines - 1); ++i)
        for (int j = std::max(k - samples, 0); j <= std::min(k + samples, probe.samples - 1); ++j)
          found = found || b.medium[at(i, j)] == a.medium[at(line, k)];
      farther += found ? 0 : 1;
    }
  return static_cast<double>(farther) / static_cast<double>(a.medium.size());
}

// Where the plan leaves refraction out, rays that are forced to bend, with all else forced on, meet
// the same media within what was accepted. One sample in a hundred is left to the quarter of a
// field's lines that the rule leaves out.
TEST(RefractionRule, ForcedOnWhereItIsLeftOutNothingMovesByMoreThanAccepted) {
  struct Varied {
    const char *lens_m_s, *sector_deg, *frequency_mhz, *lens_at;
  };
  const Varied scenes[] = {{"1580", "70", "2.5", "ball.obj"},  {"1590", "70", "2.5", "ball.obj"},
                           {"1582", "80", "4", "ball.obj"},    {"1592", "90", "2", "ball.obj"},
                           {"1450", "70", "2.5", "deep.obj"},  {"1700", "60", "3", "deep.obj"},
                           {"1575", "70", "2.5", "cross.obj"}, {"1594", "50", "4", "cross.obj"}};
  const TempFolder folder;
  for (const Varied& varied : scenes) {
    SCOPED_TRACE(std::string(varied.lens_m_s) + " m/s, " + varied.lens_at);
    SceneText text = ballAndWall(folder, "lens", std::string("\"") + varied.lens_at + "\"");
    writeObj(icosphere(3, 1.5).moved({1, 0.1, 11.7}), folder / "deep.obj");
    writeObj(box({-3, -2, 5.5}, {3, 2, 6}), folder / "cross.obj");
    text.media.replace(text.media.find("1450"), 4, varied.lens_m_s);
    text.probe["sector_deg"] = varied.sector_deg;
    text.probe["frequency_mhz"] = varied.frequency_mhz;
    text.probe["lines"] = "256";
    text.probe["samples"] = "256";
    text.output["channels"] = "[\"medium.id\"]";
    const Labelled planned = labelledFrame(folder, text, {}, ""),
                   forced = labelledFrame(folder, text,
                                          {"reflection", "lobe", "transmission_loss", "refraction",
                                           "attenuation", "backscatter", "spread", "beam_width",
                                           "snell_angles", "reflection_cap", "thin_layers"},
                                          "\"on\"");
    EXPECT_FALSE(planned.bent);
    EXPECT_TRUE(forced.bent);
    EXPECT_NE(planned.medium, forced.medium);
    const double widths = planned.scene.accuracy.refraction_tolerance_beam_widths;
    EXPECT_LT(shareFartherThan(planned, forced, widths), kLeftToFew);
    EXPECT_LT(shareFartherThan(forced, planned, widths), kLeftToFew);
  }
}

// The measure sees a lens that calls for it.
TEST(RefractionRule, LeftOutWhereItIsCalledForMediaMoveByMoreThanAccepted) {
  const TempFolder folder;
  SceneText text = ballAndWall(folder, "lens");
  text.probe["lines"] = text.probe["samples"] = "256";
  text.output["channels"] = "[\"medium.id\"]";
  const Labelled bent = labelledFrame(folder, text, {}, ""),
                 straight = labelledFrame(folder, text, {"refraction"}, "\"off\"");
  EXPECT_TRUE(bent.bent);
  const double widths = bent.scene.accuracy.refraction_tolerance_beam_widths;
  EXPECT_GT(shareFartherThan(bent, straight, widths), 2 * kLeftToFew);
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
