// Where a dataset's probe stands, the chest stands too.

#include "dataset/aim.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "dataset/cavity_marks.h"
#include "dataset/dataset_loop.h"
#include "dataset/populations.h"
#include "motion/surfaces/probe_placement.h"
#include "scene/beam_profile.h"
#include "support/recorded_heart.h"

namespace echocine {
namespace {

using namespace support;

dataset::Draw drawWith(const dataset::Values& values) {
  dataset::Draw draw;
  draw.values = values;
  draw.view_values.resize(1);
  return draw;
}

heart::Recording surrounded(const dataset::Values& values) {
  const RecordedHeart& made = recordedHeart({}, 8);
  heart::Recording recording = made.recording;
  dataset::Spec spec;
  spec.views = {View::a4c};
  dataset::surroundProbe(spec, drawWith(values), 0, made.model, recording);
  return recording;
}

Vec3d middleOf(const heart::RecordedPart& part) {
  Vec3d sum;
  for (const Vec3d& p : part.control_m.front()) sum = sum + p;
  return 1.0 / static_cast<double>(part.control_m.front().size()) * sum;
}

// Up to the micrometre that recordings are rounded to.
TEST(DatasetAim, AProbeHeldAsInTheStandardViewChangesNothing) {
  const heart::Recording &before = recordedHeart({}, 8).recording, after = surrounded({});
  ASSERT_EQ(after.parts.size(), before.parts.size());
  for (const heart::RecordedPart& part : after.parts) {
    const std::vector<Vec3d>& points = before.part(part.kind.name).control_m.front();
    ASSERT_EQ(part.control_m.front().size(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
      EXPECT_LT(length(part.control_m.front()[i] - points[i]), 2e-6) << part.kind.name;
  }
}

// Left where it was, the fat would lie beside a probe that slides by its own radius, and its edge,
// along the beams, would shade the heart.
TEST(DatasetAim, TheChestWallSlidesWithTheProbe) {
  const heart::ProbePose& held = recordedHeart({}, 8).recording.pose;
  const heart::Recording moved =
      surrounded({{"offset.shift_lateral_mm", 6.0}, {"offset.tilt_deg", 5.0}});
  for (const char* wall : {"chest_fat", "chest_muscle"}) {
    const Vec3d from = middleOf(recordedHeart({}, 8).recording.part(wall)),
                to = middleOf(moved.part(wall));
    EXPECT_LT(length(to - from - 6e-3 * held.lateral), 1e-5) << wall;
  }
  EXPECT_EQ(length(moved.pose.apex - held.apex), 0);
}

TEST(DatasetAim, TheHeartIsWhereItWas) {
  const heart::Recording moved = surrounded({{"offset.shift_lateral_mm", 6.0}});
  const heart::RecordedPart& part = moved.part("lv_cavity");
  const heart::RecordedPart& before = recordedHeart({}, 8).recording.part("lv_cavity");
  for (std::size_t k = 0; k < part.control_m.size(); ++k)
    for (std::size_t i = 0; i < part.control_m[k].size(); ++i)
      EXPECT_EQ(length(part.control_m[k][i] - before.control_m[k][i]), 0);
}

Pose poseWith(const dataset::Values& values) {
  dataset::Spec spec;
  spec.views = {View::a4c};
  const RecordedHeart& made = recordedHeart({}, 8);
  return dataset::sceneOf(spec, drawWith(values), 0, made.model.parameters(), made.recording)
      .probe.pose;
}

// As probe.tilt_deg and probe.rotate_deg.
TEST(DatasetAim, OffsetsTurnAsTheKeysOfTheProbe) {
  const Pose held = poseWith({}), tilted = poseWith({{"offset.tilt_deg", 10.0}}),
             rotated = poseWith({{"offset.rotate_deg", 10.0}}),
             both = poseWith({{"offset.rotate_deg", 10.0}, {"offset.tilt_deg", -7.0}});
  const double ten = radiansFromDegrees(10);
  EXPECT_NEAR(dot(tilted.z_axis, held.y_axis), std::sin(ten), 1e-9);
  EXPECT_NEAR(dot(rotated.x_axis, held.y_axis), std::sin(ten), 1e-9);
  const Pose wanted = turnedAndTilted(held, ten, radiansFromDegrees(-7));
  EXPECT_LT(length(both.x_axis - wanted.x_axis) + length(both.z_axis - wanted.z_axis), 1e-9);
}

TEST(DatasetAim, ThePlaneMissesTheApexByTheDistanceThatIsDrawn) {
  const Vec3d apex = dataset::marksOf(recordedHeart({}, 8).recording, 0).apex;
  const double before_m = poseWith({}).fromWorld(apex).y;
  for (const double miss_mm : {-30.0, 4.0, 12.0})
    EXPECT_NEAR(std::abs(poseWith({{"offset.apex_miss_mm", miss_mm}}).fromWorld(apex).y - before_m),
                1e-3 * std::abs(miss_mm), 2e-4)
        << miss_mm;
}

// A value of the spec replaces that of the population, and a small group one that holds it.
TEST(DatasetAim, OverlappingSegmentsHaveTheValueOfTheSmallestGroup) {
  const auto amplitudesOf = [](const std::string& text) {
    const dataset::Spec spec =
        dataset::parseSpec("hearts = 1\nviews = [\"a4c\"]\n" + text, "spec.toml");
    std::vector<double> amplitudes;
    const heart::ParametricHeart model = dataset::modelOf(spec, dataset::drawOf(spec, 0, 0).values);
    for (const heart::Segment& segment : model.parameters().segments)
      amplitudes.push_back(segment.amplitude);
    return amplitudes;
  };
  const std::vector<double> nested = amplitudesOf(
      "[heart.segments.all]\namplitude = 0.9\n[heart.segments.apical]\namplitude = 0.5\n"
      "[heart.segments.17]\namplitude = 0.2\n");
  EXPECT_EQ(nested[16], 0.2);
  for (const int apical : dataset::segmentsOf("apical"))
    if (apical != 17) {
      EXPECT_EQ(nested[static_cast<std::size_t>(apical - 1)], 0.5) << apical;
    }
  EXPECT_EQ(nested[0], 0.9);
  const std::vector<double> given =
      amplitudesOf("[populations]\ninfarct_lad = 1\n[heart.segments.all]\namplitude = 1\n");
  EXPECT_EQ(given, std::vector<double>(heart::kSegments, 1.0));
}

// The beam's thickness depends on the path from the probe, not on the depth.
TEST(DatasetAim, TracksAreShownWithinTheBeamAtTheirPath) {
  dataset::LoopSample loop;
  Probe& probe = loop.scene.probe;
  probe.frequency_hz = 2.5e6;
  probe.first_angle_rad = -0.7;
  probe.last_angle_rad = 0.7;
  probe.max_depth_m = 0.15;
  constexpr double kPath_m = 0.12, kAngle_rad = 0.6;
  const auto halfAt = [&](double path_m) {
    return 0.5 * elevationBeamWidth(path_m, probe.elevation_aperture_m, probe.elevation_focus_m,
                                    kScannerSpeed / probe.frequency_hz);
  };
  const double half_m = halfAt(kPath_m), x = kPath_m * std::sin(kAngle_rad),
               z = kPath_m * std::cos(kAngle_rad);
  ASSERT_GT(half_m, 1.1 * halfAt(z));
  const auto shown = [&](double y) { return dataset::isShown(loop, toFloat(Vec3d{x, y, z})); };
  EXPECT_TRUE(shown(0.99 * half_m));
  EXPECT_TRUE(shown(-0.99 * half_m));
  EXPECT_FALSE(shown(1.01 * half_m));
  EXPECT_FALSE(
      dataset::isShown(loop, toFloat(Vec3d{0.13 * std::sin(0.8), 0, 0.13 * std::cos(0.8)})));
}

}  // namespace
}  // namespace echocine
