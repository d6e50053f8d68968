// [probe] view: what a scene says of it, and what becomes of it.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "motion/surfaces/mesh_motion.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/probe_pose.h"
#include "scene/view_names.h"
#include "tests/stage/ball_heart.h"

namespace echocine {
namespace {

using namespace support;

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
  tilted.probe["tilt_deg"] = "5";
  const Pose leaning = placed(read(tilted)).probe.pose;
  EXPECT_NEAR(dot(leaning.x_axis, still.x_axis), 1, 1e-10);
  EXPECT_NEAR(dot(leaning.z_axis, still.y_axis), std::sin(5 * std::numbers::pi / 180), 1e-5);
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
  EXPECT_NE(told({"lv", "rv"}).find("mitral valve"), std::string::npos);
}

TEST(ProbeView, MotionThatIsNotPlacedIsRefused) {
  EXPECT_THROW(MeshMotion{read(viewScene(kAll))}, SceneError);
}

}  // namespace
}  // namespace echocine
