// The place and size of meshes, and the interval of keyframes.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "motion/surfaces/heart_size.h"
#include "tests/stage/ball_heart.h"

namespace echocine {
namespace {

using namespace support;

// A heart that stands elsewhere is seen from elsewhere, and just so.
TEST(MeshPlace, ScaleAndOffsetMoveTheMeshesAndTheProbeWithThem) {
  const Scene plain = placed(read(viewScene(kAll)));
  SceneText text = viewScene(kAll);
  text.motion["mesh_scale"] = "0.5";
  text.motion["mesh_offset_mm"] = "[100, -20, 7]";
  const Scene moved = placed(read(text));
  EXPECT_LT(
      length(moved.probe.pose.origin - (0.5 * plain.probe.pose.origin + Vec3d{0.1, -0.02, 0.007})),
      1e-6);
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
TEST(MeshPlace, AnOffsetMovesTheMeshesAlone) {
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

TEST(MeshPlace, ScaleOfNothingIsRefused) {
  for (const char* bad : {"0", "nan", "-1", "inf"}) {
    SceneText text = viewScene(kAll);
    text.motion["mesh_scale"] = bad;
    expectRefused(text, {"motion.mesh_scale", "1e-06"});
  }
  SceneText text = viewScene(kAll);
  text.motion["mesh_offset_mm"] = "[0, 0, nan]";
  expectRefused(text, {"motion.mesh_offset_mm", "component 3"});
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
