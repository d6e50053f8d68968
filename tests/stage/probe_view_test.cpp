// [probe] view, the place and size of meshes, and the interval of keyframes: what a scene says of
// them, and what becomes of it.

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "motion/heart_size.h"
#include "motion/mesh_motion.h"
#include "motion/probe_placement.h"
#include "scene/probe_pose.h"
#include "scene/view_names.h"
#include "support/meshes.h"
#include "support/scene_text.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

using namespace support;

// A ball of 1 cm, stretched and put somewhere, mm.
TriangleMesh ellipsoid(Vec3d centre, Vec3d half) {
  const Mesh ball = icosphere(2, 1);
  TriangleMesh mesh;
  mesh.triangles = ball.triangles;
  for (const Vec3d p : ball.points)
    mesh.positions.push_back(centre + Vec3d{half.x * p.x, half.y * p.y, half.z * p.z});
  return mesh;
}

// A heart of balls in the axes of the parametric one, mm: z to the apex, x lateral, y anterior.
using Heart = std::map<std::string, std::vector<TriangleMesh>>;  // keyframes by name
const Heart& ballHeart() {
  static const Heart meshes = [] {
    Heart m;
    const auto add = [&](const char* name, Vec3d centre, Vec3d half) {
      m[name] = {ellipsoid(centre, half)};
    };
    add("lv", {0, 0, 45}, {25, 25, 45});
    add("rv", {-32, 13, 40}, {14, 25, 35});
    add("la", {0, -4, -18}, {20, 20, 20});
    add("ra", {-48, 0, -10}, {18, 18, 18});
    add("aorta", {-12, 24, -16}, {12, 12, 18});
    return m;
  }();
  return meshes;
}

NamedMeshes named(const Heart& heart) {
  NamedMeshes meshes;
  for (const auto& [name, keyframes] : heart)
    for (std::size_t k = 0; k < keyframes.size(); ++k)
      meshes[name + "_" + std::string(k < 10 ? "0" : "") + std::to_string(k)] =
          std::make_shared<const TriangleMesh>(keyframes[k]);
  return meshes;
}

SceneText viewScene(const std::vector<std::string>& structures) {
  SceneText text;
  text.probe = {{"view", "\"a4c\""}, {"lines", "16"}, {"samples", "64"}};
  text.motion = {{"mesh_unit", "\"mm\""}};
  for (const std::string& name : structures)
    text.structures += "[[structure]]\nname = \"" + name + "\"\nmedium = \"blood\"\nkeyframes = \"" + name + "_*\"\n";
  return text;
}
const std::vector<std::string> kAll{"lv", "rv", "la", "ra", "aorta"};

Scene read(const SceneText& text, const Heart& heart = ballHeart()) {
  return parseScene(text.text(), "scene.toml", named(heart));
}
std::string refusal(const SceneText& text, const Heart& heart = ballHeart()) {
  try {
    placed(read(text, heart));
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}
void expectRefused(const SceneText& text, const std::vector<std::string>& says,
                   const Heart& heart = ballHeart()) {
  const std::string message = refusal(text, heart);
  for (const std::string& part : says)
    EXPECT_NE(message.find(part), std::string::npos) << part << " in: " << message;
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}
bool samePose(const Pose& a, const Pose& b) {
  return a.origin == b.origin && a.x_axis == b.x_axis && a.y_axis == b.y_axis &&
         a.z_axis == b.z_axis;
}

TEST(ProbeView, NamesTakeEitherKindOfDash) {
  for (const char* key : {"psax_base", "psax-base"}) EXPECT_EQ(viewOf(key), View::psax_base);
  for (const ViewName& name : viewNames()) EXPECT_EQ(viewOf(keyOf(name.view)), name.view);
  EXPECT_EQ(viewOf("a5c"), std::nullopt);
}

TEST(ProbeView, AViewAloneIsAWholeProbe) {
  for (const ViewName& name : viewNames()) {
    SceneText text = viewScene(kAll);
    text.probe["view"] = std::string("\"") + name.key + "\"";
    const Scene scene = placed(read(text));
    EXPECT_FALSE(scene.view) << name.key;
    EXPECT_NEAR(scene.probe.last_angle_rad * 2, 80 * std::numbers::pi / 180, 1e-12);
    EXPECT_EQ(scene.probe.frequency_hz, 2.5e6);
    EXPECT_GT(scene.probe.max_depth_m, 0.08) << name.key;
    EXPECT_LT(scene.probe.max_depth_m, 0.25) << name.key;
    EXPECT_EQ(scene.probe.focus_m, defaultFocus(scene.probe.max_depth_m)) << name.key;
    EXPECT_NO_THROW(MeshMotion{scene}) << name.key;
  }
}

TEST(ProbeView, KeysThatAreGivenStay) {
  SceneText text = viewScene(kAll);
  text.probe["sector_deg"] = "60";
  text.probe["depth_mm"] = "123.4";
  text.probe["focus_mm"] = "70";
  text.probe["frequency_mhz"] = "3.5";
  const Probe probe = placed(read(text)).probe;
  EXPECT_EQ(probe.max_depth_m, 123.4 * 1e-3);
  EXPECT_EQ(probe.focus_m, 70 * 1e-3);
  EXPECT_EQ(probe.frequency_hz, 3.5e6);
  EXPECT_NEAR(probe.last_angle_rad, 30 * std::numbers::pi / 180, 1e-12);
}

// The lines that are reported, pasted, are the same scene to the last bit, in any unit.
TEST(ProbeView, ThePastedPoseIsTheSameToTheLastBit) {
  for (const char* unit : {"mm", "cm", "m"})
    for (const ViewName& name : viewNames()) {
      SceneText text = viewScene(kAll);
      text.motion["mesh_unit"] = std::string("\"") + unit + "\"";
      text.motion["mesh_scale"] = unit[0] == 'c' ? "0.1" : unit[1] == 'm' ? "1" : "0.001";
      text.probe["view"] = std::string("\"") + name.key + "\"";
      text.probe["rotate_deg"] = "17.3";
      const Scene found = placed(read(text));
      SceneText pasted = text;
      for (const char* key : {"view", "rotate_deg"}) pasted.probe.erase(key);
      std::string all = pasted.text();
      all.replace(all.find("[probe]\n"), 8, "[probe]\n" + poseToml(found));
      const Scene again = placed(parseScene(all, "scene.toml", named(ballHeart())));
      EXPECT_TRUE(samePose(found.probe.pose, again.probe.pose)) << name.key << " " << unit;
      EXPECT_EQ(found.probe.max_depth_m, again.probe.max_depth_m) << name.key;
      EXPECT_EQ(found.probe.focus_m, again.probe.focus_m) << name.key;
      EXPECT_EQ(found.probe.first_angle_rad, again.probe.first_angle_rad) << name.key;
      EXPECT_EQ(found.probe.frequency_hz, again.probe.frequency_hz) << name.key;
      EXPECT_EQ(poseToml(found), poseToml(again)) << name.key;
    }
}

TEST(ProbeView, ShiftsAndTurnsGoAlongTheProbesAxes) {
  const Pose still = placed(read(viewScene(kAll))).probe.pose;
  SceneText shifted = viewScene(kAll);
  shifted.probe["shift_mm"] = "[3, -4, 5]";
  const Vec3d moved = still.fromWorld(placed(read(shifted)).probe.pose.origin);
  EXPECT_LT(length(moved - Vec3d{3e-3, -4e-3, 5e-3}), 1e-6);
  SceneText turned = viewScene(kAll);
  turned.probe["rotate_deg"] = "30";
  const Pose round = placed(read(turned)).probe.pose;
  EXPECT_NEAR(dot(round.z_axis, still.z_axis), 1, 1e-10);
  EXPECT_NEAR(dot(round.x_axis, still.y_axis), 0.5, 1e-5);
  SceneText tilted = viewScene(kAll);
  tilted.probe["tilt_deg"] = "30";
  const Pose leaning = placed(read(tilted)).probe.pose;
  EXPECT_NEAR(dot(leaning.x_axis, still.x_axis), 1, 1e-10);
  EXPECT_NEAR(dot(leaning.z_axis, still.y_axis), 0.5, 1e-5);
  EXPECT_LT(length(leaning.origin - still.origin), 1e-6);
}

TEST(ProbeView, ACurvilinearFaceStandsWhereAPhasedOneDoes) {
  const Probe phased = placed(read(viewScene(kAll))).probe;
  SceneText text = viewScene(kAll);
  text.probe["kind"] = "\"curvilinear\"";
  text.probe["face_radius_mm"] = "40";
  const Probe curved = placed(read(text)).probe;
  EXPECT_LT(length(curved.pose.origin + 0.04 * curved.pose.z_axis - phased.pose.origin), 1e-6);
}

// A heart that stands elsewhere is seen from elsewhere, and just so.
TEST(ProbeView, ScaleAndOffsetMoveTheMeshesAndTheProbeWithThem) {
  const Scene plain = placed(read(viewScene(kAll)));
  SceneText text = viewScene(kAll);
  text.motion["mesh_scale"] = "0.5";
  text.motion["mesh_offset_mm"] = "[100, -20, 7]";
  const Scene moved = placed(read(text));
  EXPECT_LT(length(moved.probe.pose.origin -
                   (0.5 * plain.probe.pose.origin + Vec3d{0.1, -0.02, 0.007})), 1e-6);
  const MeshMotion one(plain), other(moved);
  SurfaceFrame a, b;
  one.frameAt(0, a);
  other.frameAt(0, b);
  for (std::size_t s = 0; s < a.positions_m.size(); ++s) {
    EXPECT_NEAR(other.volumeIn(b, other.surfaces()[s]) / one.volumeIn(a, one.surfaces()[s]), 0.125,
                1e-5);
    for (std::size_t v = 0; v < a.positions_m[s].size(); v += 7)
      EXPECT_LT(length(toDouble(b.positions_m[s][v]) - 0.5 * toDouble(a.positions_m[s][v])), 2e-6);
  }
}

// With a probe of its own place, it is the meshes that move.
TEST(ProbeView, AnOffsetMovesTheMeshesAlone) {
  SceneText text = viewScene(kAll);
  text.probe.erase("view");
  for (const auto& [key, value] : SceneText{}.probe) text.probe[key] = value;
  text.motion["mesh_offset_mm"] = "[1, 2, 3]";
  const MeshMotion moved(read(text));
  text.motion.erase("mesh_offset_mm");
  const MeshMotion still(read(text));
  SurfaceFrame a, b;
  moved.frameAt(0, a);
  still.frameAt(0, b);
  EXPECT_LT(length(a.positions_m[0][0] - b.positions_m[0][0] - Vec3f{1e-3f, 2e-3f, 3e-3f}), 1e-7f);
}

TEST(ProbeView, WhatContradictsIsOneLineWithARemedy) {
  SceneText text = viewScene(kAll);
  text.probe["apex"] = "[0, 0, 0]";
  expectRefused(text, {"probe.apex", "contradicts view", "shift_mm"});
  text = viewScene(kAll);
  text.probe["view"] = "\"a5c\"";
  expectRefused(text, {"probe.view", "a5c", "psax-mid"});
  text = viewScene(kAll);
  text.probe.erase("view");
  expectRefused(text, {"probe.apex", "view = \"a4c\""});
  text = viewScene(kAll);
  text.probe = SceneText{}.probe;
  text.probe["tilt_deg"] = "3";
  expectRefused(text, {"probe.tilt_deg", "view"});
  for (const char* bad : {"nan", "91"}) {
    text = viewScene(kAll);
    text.probe["tilt_deg"] = bad;
    expectRefused(text, {"probe.tilt_deg", "-90"});
  }
  text = viewScene(kAll);
  text.probe["shift_mm"] = "[0, nan, 0]";
  expectRefused(text, {"probe.shift_mm", "component 2"});
}

TEST(ProbeView, ScaleOfNothingIsRefused) {
  for (const char* bad : {"0", "nan", "-1", "inf"}) {
    SceneText text = viewScene(kAll);
    text.motion["mesh_scale"] = bad;
    expectRefused(text, {"motion.mesh_scale", "1e-06"});
  }
  SceneText text = viewScene(kAll);
  text.motion["mesh_offset_mm"] = "[0, 0, nan]";
  expectRefused(text, {"motion.mesh_offset_mm", "component 3"});
}

TEST(ProbeView, RolesThatAreMissingOrContradictAreNamed) {
  expectRefused(viewScene({"la", "ra"}), {"probe.view", "there are la, ra", "lv_cavity"});
  SceneText base = viewScene({"lv", "rv", "la", "ra"});
  base.probe["view"] = "\"psax_base\"";
  expectRefused(base, {"aortic_valve", "psax-mid"});
  // The atria of each other.
  Heart swapped = ballHeart();
  std::swap(swapped["la"], swapped["ra"]);
  expectRefused(viewScene(kAll), {"la (role la)", "left and right are mixed up"}, swapped);
  Heart upside = ballHeart();
  upside["aorta"] = {ellipsoid({0, 0, 130}, {10, 10, 20})};
  expectRefused(viewScene(kAll), {"opposite ends", "la", "aorta"}, upside);
  Heart afar = ballHeart();
  afar["rv"] = {ellipsoid({-800, 0, 40}, {14, 25, 35})};
  expectRefused(viewScene(kAll), {"rv (role rv_cavity)", "mm from the left ventricle"}, afar);
}

TEST(ProbeView, AViewBesideTheHeartSaysWhereItIs) {
  SceneText text = viewScene(kAll);
  text.probe["shift_mm"] = "[0, 300, 0]";
  expectRefused(text, {"probe.view", "cuts none", "in elevation", "view = \"a4c\" without"});
}

TEST(ProbeView, GuessesAreWarnings) {
  EXPECT_TRUE(placed(read(viewScene(kAll))).warnings.size() ==
              read(viewScene(kAll)).warnings.size());
  const auto told = [](const std::vector<std::string>& structures) {
    std::string all;
    for (const std::string& w : placed(read(viewScene(structures))).warnings) all += w + "\n";
    return all;
  };
  EXPECT_NE(told({"lv"}).find("right heart"), std::string::npos);
  EXPECT_NE(told({"lv", "rv"}).find("mitral ring"), std::string::npos);
}

TEST(ProbeView, MotionThatIsNotPlacedIsRefused) {
  EXPECT_THROW(MeshMotion{read(viewScene(kAll))}, SceneError);
}

// A beat of keyframes 40 ms apart.
TEST(KeyframeInterval, TimesTheirNumberIsTheBeat) {
  Heart meshes = ballHeart();
  meshes["lv"] = std::vector<TriangleMesh>(20, ballHeart().at("lv").front());
  SceneText text = viewScene(kAll);
  text.motion["keyframe_interval_ms"] = "40";
  text.acquisition.erase("heart_rate_bpm");
  const Scene scene = read(text, meshes);
  EXPECT_NEAR(*scene.motion.keyframe_heart_rate_hz, 1.25, 1e-12);
  EXPECT_NEAR(scene.acquisition.heart_rate_hz, 1.25, 1e-12);
  text.acquisition["heart_rate_bpm"] = "60";
  EXPECT_NEAR(read(text, meshes).acquisition.heart_rate_hz, 1, 1e-12);
  text.motion["end_systole_phase"] = "0.4";
  EXPECT_NO_THROW(read(text, meshes));
}

TEST(KeyframeInterval, ContradictionsAreRefused) {
  SceneText text = viewScene(kAll);
  text.motion["keyframe_interval_ms"] = "40";
  expectRefused(text, {"motion.keyframe_interval_ms", "one keyframe"});
  text.motion["keyframe_heart_rate_bpm"] = "70";
  expectRefused(text, {"motion.keyframe_interval_ms", "contradicts keyframe_heart_rate_bpm"});
  text.motion.erase("keyframe_heart_rate_bpm");
  Heart meshes = ballHeart();
  meshes["lv"] = std::vector<TriangleMesh>(20, ballHeart().at("lv").front());
  meshes["rv"] = std::vector<TriangleMesh>(10, ballHeart().at("rv").front());
  expectRefused(text, {"lv has 20 keyframes and rv has 10"}, meshes);
  text.motion["keyframe_interval_ms"] = "0";
  expectRefused(text, {"motion.keyframe_interval_ms", "0.01"});
}

std::string sizeToldOf(const std::string& scale) {
  SceneText text = viewScene({"lv", "rv"});
  text.motion["mesh_scale"] = scale;
  const Scene scene = placed(read(text));
  std::string all;
  for (const std::string& w : sizeWarnings(scene, MeshMotion(scene))) all += w;
  return all;
}

// 117 mL as it is: 117 litres and 0.1 mL by a unit too large or too small.
TEST(HeartSize, WhatNoHeartHasIsToldWithWhatWouldFit) {
  EXPECT_EQ(sizeToldOf("1"), "");
  EXPECT_EQ(sizeToldOf("0.3"), "");  // a newborn's
  EXPECT_NE(sizeToldOf("5").find("motion.mesh_scale = 0.99"), std::string::npos) << sizeToldOf("5");
  EXPECT_NE(sizeToldOf("0.06").find("encloses 0.02"), std::string::npos) << sizeToldOf("0.06");
  EXPECT_NE(sizeToldOf("0.1").find("motion.mesh_unit = \"cm\""), std::string::npos)
      << sizeToldOf("0.1");
}

}  // namespace
}  // namespace echocine
