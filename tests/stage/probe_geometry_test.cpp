// Where scan lines start and point, for each kind of probe.

#include <gtest/gtest.h>

#include "scene/scan_geometry.h"
#include "support/scene_text.h"

namespace echocine {
namespace {

using support::SceneText;

Probe probeOf(const std::map<std::string, std::string>& keys) {
  SceneText text = SceneText::oneBox("blood");
  for (const auto& [key, value] : keys) text.setProbe(key, value);
  if (keys.contains("kind") && keys.at("kind") == "\"linear\"") text.probe.erase("sector_deg");
  return support::parsed(text).probe;
}

double angleOf(const LineGeometry& line) {
  return std::atan2(line.direction.x, line.direction.z);
}

TEST(PhasedProbe, LinesMeetInTheApexAndSpanTheSectorEdgesIncluded) {
  const Probe probe = probeOf({{"lines", "5"}, {"sector_deg", "80"}});
  for (int i = 0; i < 5; ++i) {
    const LineGeometry line = lineGeometry(probe, i);
    EXPECT_EQ(line.origin, (Vec3d{0, 0, 0}));
    EXPECT_NEAR(length(line.direction), 1, 1e-15);
    EXPECT_EQ(line.direction.y, 0);
    EXPECT_NEAR(angleOf(line) * 180 / std::numbers::pi, -40 + 20 * i, 1e-12);
  }
  EXPECT_NEAR(lineSpacing(probe, 0.1), 0.1 * 20 * std::numbers::pi / 180, 1e-15);
}

TEST(CurvilinearProbe, LinesStartOnTheFaceAndPointAwayFromTheCentre) {
  const Probe probe =
      probeOf({{"kind", "\"curvilinear\""}, {"face_radius_mm", "50"}, {"lines", "3"}});
  for (int i = 0; i < 3; ++i) {
    const LineGeometry line = lineGeometry(probe, i);
    EXPECT_NEAR(length(line.origin), 0.05, 1e-15);
    EXPECT_LT(length(line.origin - 0.05 * line.direction), 1e-15);
    EXPECT_NEAR(angleOf(line) * 180 / std::numbers::pi, -35 + 35 * i, 1e-12);
  }
  EXPECT_NEAR(lineSpacing(probe, 0.1), 0.15 * 35 * std::numbers::pi / 180, 1e-15);
}

TEST(LinearProbe, LinesAreParallelAndSpanTheWidthEdgesIncluded) {
  const Probe probe = probeOf({{"kind", "\"linear\""}, {"width_mm", "40"}, {"lines", "5"}});
  for (int i = 0; i < 5; ++i) {
    const LineGeometry line = lineGeometry(probe, i);
    EXPECT_EQ(line.direction, (Vec3d{0, 0, 1}));
    EXPECT_NEAR(line.origin.x, -0.02 + 0.01 * i, 1e-15);
  }
  EXPECT_NEAR(lineSpacing(probe, 0.1), 0.01, 1e-15);
}

// At steps over four decades about places from near the apex to the deepest, and across it.
TEST(AnyProbe, APositionBesideAKnownOneIsThatOfItsOwn) {
  const Probe probes[] = {
      probeOf({{"lines", "64"}, {"sector_deg", "80"}}),
      probeOf({{"kind", "\"curvilinear\""}, {"face_radius_mm", "50"}, {"lines", "64"}}),
      probeOf({{"kind", "\"linear\""}, {"width_mm", "40"}, {"lines", "64"}})};
  for (const Probe& probe : probes) {
    const ScanGeometry geometry(probe);
    int shown = 0;
    for (const Vec3d known :
         {Vec3d{0, 0, 0.002}, {0.01, 0, 0.03}, {-0.03, 0, 0.07}, {0.001, 0, 0.15}})
      for (double step_m = 1e-6; step_m < 0.02; step_m *= 3)
        for (int turn = 0; turn < 8; ++turn) {
          const double angle_rad = turn * std::numbers::pi / 4;
          const Vec3d p = known + step_m * Vec3d{std::cos(angle_rad), 0, std::sin(angle_rad)};
          const auto right = geometry.beamPosition(p.x, p.z);
          const auto found = geometry.beamPositionBeside(known, geometry.placeOf(known), p);
          ASSERT_EQ(found.has_value(), right.has_value()) << p.x << " " << p.z;
          if (!right) continue;
          ++shown;
          EXPECT_NEAR(found->line, right->line, 1e-11 * probe.lines);
          EXPECT_NEAR(found->path_m, right->path_m, 1e-15);
        }
    EXPECT_GT(shown, 100);
  }
}

TEST(AnyProbe, ASingleLineStandsInTheMiddle) {
  EXPECT_NEAR(angleOf(lineGeometry(probeOf({{"lines", "1"}}), 0)), 0, 1e-15);
  EXPECT_EQ(lineSpacing(probeOf({{"lines", "1"}}), 0.1), 0);
  const Probe linear = probeOf({{"kind", "\"linear\""}, {"width_mm", "40"}, {"lines", "1"}});
  EXPECT_NEAR(lineGeometry(linear, 0).origin.x, 0, 1e-15);
}

// Users' axes are rarely at right angles to the last digit: depth is kept, lateral made to fit.
TEST(AnyProbe, TheFrameIsOrthonormalWhateverTheLateralDirection) {
  const Probe probe =
      probeOf({{"axis", "[1, 2, 3]"}, {"lateral", "[5, 0.1, 7]"}, {"apex", "[1, -2, 3]"}});
  const Pose& f = probe.pose;
  for (const Vec3d axis : {f.x_axis, f.y_axis, f.z_axis}) EXPECT_NEAR(length(axis), 1, 1e-15);
  EXPECT_NEAR(dot(f.x_axis, f.y_axis), 0, 1e-15);
  EXPECT_NEAR(dot(f.x_axis, f.z_axis), 0, 1e-15);
  EXPECT_LT(length(cross(f.x_axis, f.y_axis) - f.z_axis), 1e-15);
  EXPECT_LT(length(f.z_axis - normalised(Vec3d{1, 2, 3})), 1e-15);
  EXPECT_GT(dot(f.x_axis, Vec3d{5, 0.1, 7}), 0);
  EXPECT_LT(length(f.origin - Vec3d{0.01, -0.02, 0.03}), 1e-16);  // the mesh unit is cm
}

TEST(AnyProbe, SamplesAreCentredInTheirIntervals) {
  const Probe probe = probeOf({{"min_depth_mm", "20"}, {"depth_mm", "120"}, {"samples", "50"}});
  EXPECT_NEAR(probe.sampleSpacing(), 0.002, 1e-16);
  EXPECT_NEAR(probe.middleDepth(), 0.07, 1e-16);
}

}  // namespace
}  // namespace echocine
