// Where a loop's sector lies, and what in and about it is no echo.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/loop_reading.h"
#include "support/run_program.h"
#include "video/read_video.h"

namespace echocine::echo {
namespace {

TEST_F(Reading, TheSectorOfADrawingIsFound) {
  for (const double scale : {0.9, 1.0}) {
    Drawing d = drawing;
    d.scale = scale;
    d.shift_x = 160 * (1 - scale);
    writeLossless(folder / "loop.avi", d);
    const EchoLoop loop = readLoop(folder / "loop.avi", {}, true);
    const Sector found = loop.sector(), true_one = placedSector(d);
    EXPECT_NEAR(found.apex_x, true_one.apex_x, 1);
    EXPECT_NEAR(found.apex_y, true_one.apex_y, 1);
    EXPECT_NEAR(found.first_rad, true_one.first_rad, 0.005);
    EXPECT_NEAR(found.last_rad, true_one.last_rad, 0.005);
    EXPECT_NEAR(found.r_min, true_one.r_min, 2);
    EXPECT_NEAR(found.r_max, true_one.r_max, 1.5);
  }
}

TEST_F(Reading, ColourAndTextAreMasked) {
  std::vector<cv::Mat> pictures = coloured(frames, 320, 240);
  for (cv::Mat& p : pictures) {
    cv::circle(p, {150, 120}, 6, {0, 220, 0}, -1);
    cv::putText(p, "ES", {180, 60}, cv::FONT_HERSHEY_SIMPLEX, 0.5, {255, 255, 255});
  }
  writePictures(folder / "png", pictures, ".png");
  const EchoLoop loop = readLoop(folder / "png", {}, true);
  EXPECT_EQ(loop.overlay[120 * 320 + 150], 1);
  int text = 0;
  for (int y = 45; y < 62; ++y)
    for (int x = 178; x < 205; ++x) text += loop.overlay[static_cast<std::size_t>(y * 320 + x)];
  EXPECT_GT(text, 30);
  EXPECT_EQ(loop.overlay[150 * 320 + 100], 0);
}

// A box of colours that move, of the loop's frames.
std::vector<cv::Mat> withDoppler(const std::vector<PixelPlane>& frames, const cv::Rect& box) {
  std::vector<cv::Mat> pictures = coloured(frames, 320, 240);
  for (std::size_t f = 0; f < pictures.size(); ++f)
    for (int y = box.y; y < box.y + box.height; ++y)
      for (int x = box.x; x < box.x + box.width; ++x)
        pictures[f].at<cv::Vec3b>(y, x) =
            (x / 10 + y / 10 + int(f)) % 2 ? cv::Vec3b(200, 40, 10) : cv::Vec3b(10, 40, 220);
  return pictures;
}

TEST_F(Reading, AColourDopplerBoxIsMaskedAndSaysHowMuch) {
  writePictures(folder / "doppler", withDoppler(frames, {120, 80, 80, 70}), ".png");
  const EchoLoop loop = readLoop(folder / "doppler", {}, true);
  EXPECT_EQ(loop.overlay[115 * 320 + 160], 1);
  EXPECT_EQ(loop.overlay[200 * 320 + 160], 0);
  const auto& notes = loop.video.notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.starts_with("colour covers 1");  // 16 %, and its edges
  }));
}

TEST_F(Reading, ColourOverMostOfTheSectorIsRefused) {
  writeLossless(folder / "loop.avi", drawing);
  Video video = readVideo(folder / "loop.avi");
  const Sector sector = parseSector("--sector", "160,5,-40,40,12,225");
  EXPECT_NO_THROW(overlayMask(video, sector));
  std::fill(video.coloured.begin() + 90 * 320, video.coloured.end(), std::uint8_t{1});
  try {
    overlayMask(video, sector);
    ADD_FAILURE() << "taken";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("Doppler"), std::string::npos) << error.what();
  }
}

TEST_F(Reading, WhatIsBurntInAroundTheSectorIsBlanked) {
  std::vector<cv::Mat> pictures = coloured(frames, 320, 240);
  for (cv::Mat& p : pictures) {
    cv::putText(p, "DOE JANE", {2, 14}, cv::FONT_HERSHEY_SIMPLEX, 0.45, {255, 255, 255});
    cv::putText(p, "1950", {270, 30}, cv::FONT_HERSHEY_SIMPLEX, 0.45, {0, 220, 0});
  }
  writePictures(folder / "png", pictures, ".png");
  SideOptions side;
  side.sector = "160,5,-40,40,12,225";
  const EchoLoop loop = readLoop(folder / "png", side, true);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 320; ++x) {
      const auto at = static_cast<std::size_t>(y * 320 + x);
      if (std::abs(x - 160) < 60) continue;
      for (const PixelPlane& frame : loop.video.frames) ASSERT_EQ(frame[at], 0) << x << "," << y;
      ASSERT_EQ(loop.overlay[at], 0) << x << "," << y;
    }
}

TEST_F(Reading, AnUnseenSectorIsRefused) {
  std::vector<PixelPlane> noise;
  for (int f = 0; f < 4; ++f) {
    PixelPlane p;
    for (std::uint64_t i = 0; i < 320 * 240; ++i)
      p.push_back(static_cast<std::uint8_t>(hashOf(f, i) % 200));
    noise.push_back(p);
  }
  writeLossless(folder / "noise.avi", noise, 320, 240);
  expectRefusal(folder / "noise.avi", "no sector found");
}

TEST_F(Reading, AStretchedSectorIsRefusedAndMendedByItsAspect) {
  std::vector<cv::Mat> pictures = coloured(frames, 320, 240);
  for (cv::Mat& p : pictures) cv::resize(p, p, {320, 180});
  writePictures(folder / "flat", pictures, ".png");
  expectRefusal(folder / "flat", "pixel-aspect");
  SideOptions side;
  side.pixel_aspect = 4.0 / 3;
  const EchoLoop loop = readLoop(folder / "flat", side, true);
  EXPECT_EQ(loop.video.height, 240);
  EXPECT_NEAR(loop.sector().r_max, drawing.sector.r_max, 3);
}

TEST_F(Reading, SectorsThatDoNotOverlapAreRefused) {
  writeLossless(folder / "loop.avi", drawing);
  const Outcome o = runShell("%B compare '" + (folder / "loop.avi").string() + "' '" +
                             (folder / "loop.avi").string() + "' -o '" + (folder / "out").string() +
                             "' --synthetic-scale 1 --scale 20 --quiet");
  EXPECT_EQ(o.code, 2);
  EXPECT_NE(o.err.find("do not overlap"), std::string::npos) << o.err;
}

}  // namespace
}  // namespace echocine::echo
