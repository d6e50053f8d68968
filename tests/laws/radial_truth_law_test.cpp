// Truth of a radial probe: the same whichever way the seam lies, with straight and with bent rays.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "frame/picture_grid.h"
#include "frame/simulator.h"
#include "scene/scan_geometry.h"
#include "support/scene_text.h"

namespace echocine::radial_truth_law {
namespace {

using support::Mesh;
using support::SceneText;

constexpr int kLines = 128;

std::shared_ptr<const TriangleMesh> shared(const Mesh& mesh) {
  return std::make_shared<TriangleMesh>(TriangleMesh{mesh.points, mesh.triangles, {}, {}});
}

SceneText radialText(int lines) {
  SceneText text;
  text.motion = {{"mesh_unit", "\"mm\""}};
  text.probe.erase("sector_deg");
  text.probe["kind"] = "\"radial\"";
  text.probe["face_radius_mm"] = "4";
  text.probe["depth_mm"] = "60";
  text.probe["lines"] = std::to_string(lines);
  return text;
}

// A ball behind a slanting block, before the probe or behind it.
Scene ballScene(bool before, const char* bends) {
  SceneText text = radialText(kLines);
  text.probe["samples"] = "256";
  text.probe["axis"] = before ? "[0, 0, 1]" : "[0, 0, -1]";
  text.probe["lateral"] = before ? "[1, 0, 0]" : "[-1, 0, 0]";
  text.output = {{"width", "300"}, {"height", "300"}, {"ecg", "false"}};
  text.media = support::kGelOilMeat;
  text.background = "gel";
  text.addStructure("ball", "meat", "\"ball\"", 2);
  text.addStructure("block", "oil", "\"block\"", 1);
  text.effects["refraction"] = "\"off\"";
  if (*bends) text.effects[bends] = "\"on\"";
  Mesh block = support::box({-25, -30, 9}, {25, 30, 17});
  for (Vec3d& p : block.points) p.z += (p.z > 12 ? 0.3 : -0.1) * p.x * 0.5;
  const NamedMeshes meshes{{"ball", shared(support::icosphere(4, 11).moved({3, 1, 36}))},
                           {"block", shared(block)}};
  Scene scene = parseScene(text.text(), "in memory", meshes);
  scene.truth.labels = scene.truth.contours = true;
  scene.output.channels = {Channel::structure, Channel::displacement_axial};
  return scene;
}

struct Shown {
  Scene scene;
  Frame frame;
  Shown(bool before, const char* bends) {
    const Simulator simulator(ballScene(before, bends));
    frame = simulator.frame(0);
    scene = simulator.scene();
  }
  const Contour& ball() const {
    const auto& all = frame.truth->contours;
    const auto is_ball = [](const Contour& c) { return c.surface == SurfaceId{0}; };
    EXPECT_EQ(std::count_if(all.begin(), all.end(), is_ball), 1);
    return *std::find_if(all.begin(), all.end(), is_ball);
  }
};

double areaOf(const Contour& contour) {
  double twice = 0;
  const std::vector<Vec3d>& at = contour.points_m;
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Vec3d p = at[i], q = at[(i + 1) % at.size()];
    twice += p.x * q.z - q.x * p.z;
  }
  return std::abs(twice) / 2;
}

class RadialTruth : public testing::TestWithParam<const char*> {};

// The probe turned by half a turn shows the same truth, turned: labels of samples, of pixels, and
// one closed contour.
TEST_P(RadialTruth, IsTheSameOnBothSidesOfTheSeam) {
  const Shown before(true, GetParam()), behind(false, GetParam());
  const auto& ids = before.frame.truth->sample_ids;
  const auto& turned_ids = behind.frame.truth->sample_ids;
  ASSERT_EQ(ids.size(), turned_ids.size());
  const std::size_t half = ids.size() / 2;
  std::size_t ball = 0, other = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    ball += ids[i] == 1;
    other += ids[i] != turned_ids[(i + half) % ids.size()];
  }
  EXPECT_GT(ball, 800u);
  EXPECT_LE(other, ids.size() / 2000);

  const auto &labels = before.frame.truth->labels, &turned = behind.frame.truth->labels;
  std::size_t shown = 0, unlike = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    shown += labels[i] != 0;
    unlike += labels[i] != turned[labels.size() - 1 - i];
  }
  EXPECT_GT(shown, 3000u);
  EXPECT_LE(unlike, shown / 200);

  EXPECT_TRUE(before.ball().closed);
  EXPECT_TRUE(behind.ball().closed);
  EXPECT_NEAR(areaOf(behind.ball()) / areaOf(before.ball()), 1, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Rays, RadialTruth, testing::Values("", "travel_time", "refraction"),
                         [](const auto& given) {
                           const std::string name = given.param;
                           return name.empty() ? std::string("straight") : name;
                         });

// A shell about the probe crosses every line; its contours are closed rings.
TEST(RadialContours, AShellAboutTheProbeHasClosedRings) {
  const Simulator simulator([] {
    SceneText text = radialText(96);
    text.background = "blood";
    text.addStructure("wall", "myocardium", "\"wall\"", 1);
    text.addStructure("cavity", "blood", "\"cavity\"", 2);
    const NamedMeshes meshes{{"wall", shared(support::icosphere(4, 40))},
                             {"cavity", shared(support::icosphere(4, 30))}};
    Scene shell = parseScene(text.text(), "in memory", meshes);
    shell.truth.contours = true;
    return shell;
  }());
  const Frame frame = simulator.frame(0);
  ASSERT_EQ(frame.truth->contours.size(), 2u);
  for (const Contour& ring : frame.truth->contours) {
    EXPECT_TRUE(ring.closed);
    const double radius_m = ring.surface == SurfaceId{0} ? 0.04 : 0.03;
    EXPECT_NEAR(areaOf(ring) / (std::numbers::pi * radius_m * radius_m), 1, 0.01);
  }
}

}  // namespace
}  // namespace echocine::radial_truth_law
