// Where a dataset's probe stands, the chest stands too.

#include "dataset/aim.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace echocine
