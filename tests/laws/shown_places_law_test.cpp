// Sheets, material points and landmarks stand where travel times show them. Oracle: in media of one
// speed everything is 1540 over that speed nearer to the probe.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "frame/simulator.h"
#include "plan/loop_plan.h"
#include "support/scene_text.h"

namespace echocine::shown_places_law {
namespace {

using support::Mesh;
using support::SceneText;

std::shared_ptr<const TriangleMesh> shared(const Mesh& mesh) {
  return std::make_shared<TriangleMesh>(TriangleMesh{mesh.points, mesh.triangles, {}, {}});
}

// A sheet has one open contour; it lies on the sheet as travel times show it.
TEST(ShownPlacesLaw, AMembranesContourIsOpen) {
  SceneText text;
  text.motion = {{"mesh_unit", "\"mm\""}};
  text.probe["depth_mm"] = "160";
  text.effects["travel_time"] = "\"on\"";
  text.structures =
      "[[structure]]\nname = \"sheet\"\nmedium = \"valve\"\nmembrane = true\nkeyframes = "
      "\"sheet\"\n";
  const Mesh sheet{{{-30, -20, 80}, {40, -20, 110}, {40, 20, 110}, {-30, 20, 80}},
                   {{0, 1, 2}, {0, 2, 3}}};
  Scene scene = parseScene(text.text(), "in memory", {{"sheet", shared(sheet)}});
  scene.truth.contours = true;
  const std::vector<Contour> contours = Simulator(scene).frame(0).truth->contours;
  ASSERT_EQ(contours.size(), 1u);
  EXPECT_FALSE(contours[0].closed);
  EXPECT_GT(length(contours[0].points_m.front() - contours[0].points_m.back()), 0.073);
  for (const Vec3d p : contours[0].points_m) {
    const Vec3d there = (1584.0 / 1540) * p;
    EXPECT_NEAR(there.z, 0.08 + (there.x + 0.03) * 30 / 70, 0.02e-3);
  }
}

// Sound that is faster than 1540 m/s shows what lies deeper than the picture.
TEST(ShownPlacesLaw, ASheetBehindTheDepthIsShownWhereSoundIsFast) {
  for (const bool shown : {false, true}) {
    SceneText text;
    text.motion = {{"mesh_unit", "\"mm\""}};
    text.probe["depth_mm"] = "150";
    text.effects["travel_time"] = shown ? "\"on\"" : "\"off\"";
    text.effects["refraction"] = "\"off\"";
    text.structures =
        "[[structure]]\nname = \"sheet\"\nmedium = \"valve\"\nmembrane = true\nkeyframes = "
        "\"sheet\"\n";
    const Mesh sheet{{{-30, -20, 152}, {40, -20, 152}, {40, 20, 152}, {-30, 20, 152}},
                     {{0, 1, 2}, {0, 2, 3}}};
    const Simulator simulator(parseScene(text.text(), "in memory", {{"sheet", shared(sheet)}}));
    EXPECT_EQ(simulator.plan().left_out[0], !shown);
    const Intensities made = simulator.frame(0).intensities;
    const Probe& probe = simulator.scene().probe;
    const double place = 152e-3 * 1540 / 1584;  // along the middle line
    double echo = 0, before = 0;
    for (int k = 0; k < probe.samples; ++k) {
      const double depth_m = probe.min_depth_m + (k + 0.5) * probe.sampleSpacing();
      const auto grey =
          static_cast<double>(made[static_cast<std::size_t>(probe.lines / 2 * probe.samples + k)]);
      if (std::abs(depth_m - place) < 1.5e-3) echo = std::max(echo, grey);
      if (std::abs(depth_m - place + 10e-3) < 1.5e-3) before = std::max(before, grey);
    }
    EXPECT_EQ(echo > 2 * before, shown) << echo << ' ' << before;
  }
}

// Material points and landmarks of a heart in media of one speed: 1540/1584 nearer to the probe.
TEST(ShownPlacesLaw, TracksAndLandmarksStandWhereTheyAreShown) {
  std::array<Frame, 2> frames;
  for (const bool shown : {false, true}) {
    SceneText text;
    text.motion = {{"mesh_unit", "\"mm\""}};
    text.probe["depth_mm"] = "160";
    text.effects["travel_time"] = shown ? "\"on\"" : "\"off\"";
    text.addStructure("wall", "myocardium", "\"wall\"", 1, "role = \"lv_wall\"");
    text.addStructure("cavity", "blood", "\"cavity\"", 2, "role = \"lv_cavity\"");
    text.addStructure("atrium", "blood", "\"atrium\"", 1, "role = \"la\"");
    const Mesh ball = support::icosphere(4, 25);
    const NamedMeshes meshes{{"wall", shared(ball.scaled(1.4).moved({3, 0, 80}))},
                             {"cavity", shared(ball.moved({3, 0, 80}))},
                             {"atrium", shared(ball.moved({3, 0, 122}))}};
    Scene scene = parseScene(text.text(), "in memory", meshes);
    scene.truth.function = scene.truth.tracks = true;
    frames[shown] = Simulator(scene).frame(0);
  }
  const FrameTruth &straight_ones = *frames[0].truth, &shown = *frames[1].truth;
  const auto expectShown = [](Vec3d from, Vec3d to) {
    const Vec3d by_closed_form{from.x * 1540 / 1584, from.y, from.z * 1540 / 1584};
    EXPECT_LT(length(to - by_closed_form), 0.02e-3);
  };
  ASSERT_GT(shown.tracks_m.size(), 500u);
  for (std::size_t i = 0; i < shown.tracks_m.size(); ++i)
    expectShown(toDouble(straight_ones.tracks_m[i]), toDouble(shown.tracks_m[i]));
  expectShown(straight_ones.function->axis.apex_m, shown.function->axis.apex_m);
  ASSERT_TRUE(shown.function->mitral && shown.function->mitral->hinges_m);
  expectShown(straight_ones.function->mitral->middle_m, shown.function->mitral->middle_m);
  expectShown(straight_ones.function->mitral->hinges_m->first,
              shown.function->mitral->hinges_m->first);
  EXPECT_EQ(straight_ones.function->length_mm, shown.function->length_mm);
}

}  // namespace
}  // namespace echocine::shown_places_law
