// What is measured in the imaging plane of a loop without functional truth: deviations from the
// standard view, volumes.

#include <gtest/gtest.h>

#include "dataset/make_heart.h"
#include "dataset/record.h"

namespace echocine::dataset {
namespace {

// The loops of each view, with an [offset].
Json loopsWith(const std::string& offset) {
  const Spec spec = parseSpec(
      "hearts = 1\nviews = [\"a2c\", \"a4c\", \"psax-mid\"]\nkeyframes = 8\npicture_px = 56\n"
      "[scene.probe]\nlines = 16\nsamples = 32\n[scene.acquisition]\nframe_rate_hz = 4\n"
      "[scene.signal]\nlook = \"paper\"\n[offset]\n" +
          offset,
      "spec.toml");
  const Heart heart = makeHeart(spec, 0, {});
  return recordOf(spec, heart).at("loops");
}

Json offsetsWith(const std::string& offset) {
  Json offsets;
  for (const Json& loop : loopsWith(offset)) offsets.push_back(loop.at("view_offset"));
  return offsets;
}

TEST(DatasetOffset, AStandardViewHasNone) {
  for (const Json& offset : offsetsWith("")) {
    EXPECT_NEAR(offset.at("tilt_deg").get<double>(), 0, 0.01);
    EXPECT_NEAR(offset.at("shift_mm").get<double>(), 0, 0.01);
    const bool is_short = offset.at("label") == "psax-mid";
    EXPECT_EQ(offset.at("rotation_deg").is_null(), is_short);
    EXPECT_EQ(offset.at("foreshortening_mm").is_null(), is_short);
    if (is_short) continue;
    EXPECT_NEAR(offset.at("rotation_deg").get<double>(), 0, 0.01);
    EXPECT_NEAR(offset.at("foreshortening_mm").get<double>(), 0, 0.01);
  }
}

TEST(DatasetOffset, DrawnOffsetsAreMeasured) {
  for (const Json& offset : offsetsWith("shift_elevation_mm = 5\n"))
    EXPECT_NEAR(std::abs(offset.at("shift_mm").get<double>()), 5, 0.01);
  const Json turned = offsetsWith("rotate_deg = 12\n");
  EXPECT_NEAR(turned[0].at("rotation_deg").get<double>(), -12, 0.05);
  EXPECT_NEAR(turned[0].at("tilt_deg").get<double>(), 0, 0.05);
  EXPECT_NEAR(turned[2].at("tilt_deg").get<double>(), 12, 0.05);
}

// A short axis shows no long axis, so it has no volume by discs.
TEST(DatasetOffset, OnlyViewsOfTheLongAxisHaveSinglePlaneVolumes) {
  for (const Json& loop : loopsWith("shift_elevation_mm = 3\n"))
    for (const char* name : {"edv_single_plane_ml", "esv_single_plane_ml",
                             "ef_single_plane_percent", "length_in_plane_mm"}) {
      if (loop.at("view") == "psax-mid") {
        EXPECT_TRUE(loop.at(name).is_null()) << name;
      } else {
        EXPECT_GT(loop.at(name).get<double>(), 0) << name;
      }
    }
}

}  // namespace
}  // namespace echocine::dataset
