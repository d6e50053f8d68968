// Two echo videos as labs have them: what the readers say of each.

#include <gtest/gtest.h>

#include "compare/compare.h"
#include "core/units.h"
#include "echo/beat_length.h"
#include "support/paths.h"

namespace echocine::compare {

using namespace echo;
namespace {

const std::filesystem::path kVideoFolder =
    std::filesystem::path(support::kSharedDir) / "real/videos";
const std::filesystem::path kDicom = kVideoFolder / "a4c_sonosite_30f.dcm";
const std::filesystem::path kFilm = kVideoFolder / "a4c_echotracker_45f.mp4";

class RealVideos : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::is_directory(kVideoFolder)) GTEST_SKIP() << kVideoFolder << " is absent";
  }
};

void expectSector(const EchoLoop& loop, double x, double y, double first_deg, double last_deg,
                  double radius) {
  const Sector& s = loop.sector();
  EXPECT_NEAR(s.apex_x, x, 3);
  EXPECT_NEAR(s.apex_y, y, 3);
  EXPECT_NEAR(degreesFromRadians(s.first_rad), first_deg, 1);
  EXPECT_NEAR(degreesFromRadians(s.last_rad), last_deg, 1);
  EXPECT_NEAR(s.r_max, radius, 3);
}

bool says(const std::vector<std::string>& notes, const std::string& part) {
  for (const std::string& note : notes)
    if (note.find(part) != std::string::npos) return true;
  return false;
}

TEST_F(RealVideos, TheDicomIsReadWithItsRepeatsAndItsWrongScaleIsCaught) {
  const EchoLoop loop = readLoop(kDicom, {}, true);
  EXPECT_EQ(loop.video.frameCount(), 30);
  EXPECT_EQ(loop.video.width, 320);
  EXPECT_EQ(loop.video.repeats, (std::vector<int>{11, 28}));
  EXPECT_NEAR(loop.video.rate.hz, 30, 0.01);
  EXPECT_TRUE(loop.video.rate.trusted);
  EXPECT_FALSE(loop.video.heart_rate_bpm);
  EXPECT_TRUE(says(loop.video.notes, "HeartRate tag says 0"));
  ASSERT_TRUE(loop.metres_per_pixel);
  EXPECT_NEAR(100 * *loop.metres_per_pixel, 0.1021, 1e-4);
  EXPECT_TRUE(says(loop.video.notes, "outside the 320 x 240 picture"));
  expectSector(loop, 170, 6, -42, 41.6, 197);
}

TEST_F(RealVideos, TheFilmIsReadAndItsSectorFound) {
  const EchoLoop loop = readLoop(kFilm, {}, true);
  EXPECT_EQ(loop.video.frameCount(), 45);
  EXPECT_TRUE(loop.video.repeats.empty());
  EXPECT_FALSE(loop.video.rate.trusted);
  EXPECT_FALSE(loop.metres_per_pixel);
  expectSector(loop, 511.7, -3.4, -43.1, 43.1, 770);
}

TEST_F(RealVideos, WhatTheUserSaysGoesFirst) {
  SideOptions side;
  side.fps = 61.5;
  side.mm_per_pixel = 0.2;
  side.sector = "510,-3,-43,43,5,769";
  const EchoLoop loop = readLoop(kFilm, side, true);
  EXPECT_EQ(loop.video.rate.hz, 61.5);
  EXPECT_EQ(loop.video.rate.source, "--fps");
  EXPECT_NEAR(*loop.metres_per_pixel, 2e-4, 1e-15);
  EXPECT_EQ(loop.sector().apex_x, 510);
  EXPECT_TRUE(loop.find.given);
}

}  // namespace
}  // namespace echocine::compare
