// Every kind of file that a loop comes in, written by its own library and read back; and every kind
// of file that is none.

#include <gtest/gtest.h>

#include <algorithm>

#include "compare/compare.h"
#include "core/error.h"
#include "support/echo_video.h"
#include "support/run_program.h"
#include "support/temp_folder.h"
#include "video/read_video.h"

namespace echocine::compare {
namespace {

using namespace support;

Drawing small() {
  Drawing d;
  d.frames = 6;
  return d;
}

double worstDifference(const std::vector<PixelPlane>& a, const std::vector<PixelPlane>& b) {
  if (a.size() != b.size()) return 1e9;
  double worst = 0, sum = 0, n = 0;
  for (std::size_t f = 0; f < a.size(); ++f)
    for (std::size_t p = 0; p < a[f].size(); ++p) {
      worst = std::max(worst, std::abs(double(a[f][p]) - b[f][p]));
      sum += std::abs(double(a[f][p]) - b[f][p]), ++n;
    }
  return worst + 1e-9 * sum / n;
}

std::string refusal(const std::filesystem::path& path) {
  try {
    readLoop(path, {}, true);
  } catch (const SceneError& error) {
    return error.what();
  }
  return "";
}

void expectRefusal(const std::filesystem::path& path, const std::string& part) {
  const std::string said = refusal(path);
  EXPECT_NE(said.find(part), std::string::npos) << said;
  EXPECT_EQ(said.find('\n'), std::string::npos) << said;
}

class Reading : public ::testing::Test {
 protected:
  const Drawing drawing = small();
  const std::vector<PixelPlane> frames = drawnLoop(drawing);
  TempFolder folder;
};

TEST_F(Reading, LosslessFilesGiveBackEveryGrey) {
  writePictures(folder / "png", coloured(frames, 320, 240), ".png");
  writeLossless(folder / "loop.avi", frames, 320, 240, 40);
  writeDicom(folder / "grey.dcm", frames, 320, 240, DicomKind::grey);
  writeDicom(folder / "rgb.dcm", frames, 320, 240, DicomKind::rgb);
  writeDicom(folder / "rle.dcm", frames, 320, 240, DicomKind::rle);
  writeDicom(folder / "palette.dcm", frames, 320, 240, DicomKind::palette);
  writeDicom(folder / "lossless.dcm", frames, 320, 240, DicomKind::jpeg_lossless);
  for (const char* name :
       {"png", "loop.avi", "grey.dcm", "rgb.dcm", "rle.dcm", "palette.dcm", "lossless.dcm"})
    EXPECT_EQ(worstDifference(readVideo(folder / name).frames, frames), 0) << name;
  EXPECT_NEAR(readVideo(folder / "loop.avi").rate.hz, 40, 1e-9);
  EXPECT_EQ(readVideo(folder / "rle.dcm").rate.hz, 50);  // FrameTime 20 ms
  EXPECT_EQ(readVideo(folder / "png").rate.hz, 0);
}

TEST_F(Reading, LossyFilesComeNear) {
  writePictures(folder / "jpg", coloured(frames, 320, 240), ".jpg");
  writeDicom(folder / "baseline.dcm", frames, 320, 240, DicomKind::jpeg_baseline);
  writeDicom(folder / "ybr.dcm", frames, 320, 240, DicomKind::ybr_422);
  for (const char* name : {"jpg", "baseline.dcm", "ybr.dcm"})
    EXPECT_LT(worstDifference(readVideo(folder / name).frames, frames), 24) << name;
}

TEST_F(Reading, FilmsOfFfmpegAreRead) {
  writePictures(folder / "png", coloured(frames, 320, 240), ".png");
  const std::string from =
      "ffmpeg -v error -y -framerate 25 -i '" + (folder / "png/frame_%d.png").string() + "' ";
  for (const auto& [name, how] :
       {std::pair("a.mp4", "-c:v mpeg4 -q:v 2"), std::pair("b.gif", ""),
        std::pair("c.avi", "-c:v mjpeg -q:v 2"), std::pair("d.mkv", "-c:v ffv1")}) {
    if (runShell(from + how + " '" + (folder / name).string() + "'").code != 0)
      GTEST_SKIP() << "no ffmpeg";
    const Video v = readVideo(folder / name);
    EXPECT_EQ(v.frameCount(), 6) << name;
    EXPECT_EQ(v.width, 320) << name;
    double sum = 0;
    for (std::size_t p = 0; p < frames[0].size(); ++p)
      sum += std::abs(double(v.frames[3][p]) - frames[3][p]);
    EXPECT_LT(sum / static_cast<double>(frames[0].size()), 8) << name;  // GIF has few greys
  }
}

TEST_F(Reading, NumbersInNamesCountByValue) {
  Drawing d = drawing;
  d.frames = 12;
  const std::vector<PixelPlane> dozen = drawnLoop(d);
  writePictures(folder / "png", coloured(dozen, 320, 240), ".png");  // frame_10 after frame_9
  EXPECT_EQ(worstDifference(readVideo(folder / "png").frames, dozen), 0);
}

TEST_F(Reading, RepeatsAreNamed) {
  std::vector<PixelPlane> repeated = frames;
  repeated.insert(repeated.begin() + 2, repeated[1]);
  repeated.push_back(repeated.back());
  writeLossless(folder / "loop.avi", repeated, 320, 240);
  EXPECT_EQ(readVideo(folder / "loop.avi").repeats, (std::vector<int>{2, 7}));
}

TEST_F(Reading, TagsOfAnotherPictureSizeAreCorrected) {
  const auto region = [](int factor) {
    return [factor](DcmDataset& data) {
      DcmItem* item = nullptr;
      data.findOrCreateSequenceItem(DCM_SequenceOfUltrasoundRegions, item);
      item->putAndInsertUint16(DCM_RegionDataType, 1);
      const Uint32 box[4] = {10, 2, 310, 232};
      const DcmTagKey keys[4] = {DCM_RegionLocationMinX0, DCM_RegionLocationMinY0,
                                 DCM_RegionLocationMaxX1, DCM_RegionLocationMaxY1};
      for (int i = 0; i < 4; ++i)
        item->putAndInsertUint32(keys[i], box[i] * static_cast<Uint32>(factor));
      item->putAndInsertUint16(DCM_PhysicalUnitsXDirection, 3);
      item->putAndInsertUint16(DCM_PhysicalUnitsYDirection, 3);
      item->putAndInsertFloat64(DCM_PhysicalDeltaX, 0.07 / factor);
      item->putAndInsertFloat64(DCM_PhysicalDeltaY, 0.07 / factor);
    };
  };
  for (const int factor : {1, 2, 3}) {
    const auto file = folder / ("f" + std::to_string(factor) + ".dcm");
    writeDicom(file, frames, 320, 240, DicomKind::grey, region(factor));
    const Loop loop = readLoop(file, {}, true);
    ASSERT_TRUE(loop.metres_per_pixel) << factor;
    EXPECT_NEAR(*loop.metres_per_pixel, 7e-4, 1e-9) << factor;
    EXPECT_EQ(loop.video.notes.empty(), factor == 1);
  }
}

TEST_F(Reading, TheSectorOfADrawingIsFound) {
  for (const double scale : {0.9, 1.0}) {
    Drawing d = drawing;
    d.scale = scale;
    d.shift_x = 160 * (1 - scale);
    writeLossless(folder / "loop.avi", d);
    const Loop loop = readLoop(folder / "loop.avi", {}, true);
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
  const Loop loop = readLoop(folder / "png", {}, true);
  EXPECT_EQ(loop.overlay[120 * 320 + 150], 1);
  int text = 0;
  for (int y = 45; y < 62; ++y)
    for (int x = 178; x < 205; ++x) text += loop.overlay[static_cast<std::size_t>(y * 320 + x)];
  EXPECT_GT(text, 30);
  EXPECT_EQ(loop.overlay[150 * 320 + 100], 0);
}

TEST_F(Reading, HeartRatesOfTagsAreTakenWhereAHeartCanBeatSo) {
  const auto read = [&](const DcmTagKey& key, const char* value) {
    writeDicom(folder / "loop.dcm", frames, 320, 240, DicomKind::grey,
               [&](DcmDataset& data) { data.putAndInsertString(key, value); });
    return readVideo(folder / "loop.dcm");
  };
  const Video rate = read(DCM_HeartRate, "66"), interval = read(DCM_NominalInterval, "800"),
              none = read(DCM_HeartRate, "0");
  EXPECT_EQ(rate.heart_rate_bpm, 66);
  EXPECT_EQ(rate.heart_rate_source, "DICOM HeartRate");
  EXPECT_EQ(interval.heart_rate_bpm, 75);
  EXPECT_EQ(interval.heart_rate_source, "DICOM NominalInterval");
  EXPECT_FALSE(none.heart_rate_bpm);
  ASSERT_EQ(none.notes.size(), 1u);
  EXPECT_NE(none.notes[0].find("HeartRate"), std::string::npos);
}

TEST_F(Reading, WhatIsNoLoopIsRefusedInOneLine) {
  writeLossless(folder / "one.avi", {frames[0]}, 320, 240);
  expectRefusal(folder / "one.avi", "still image");
  writeLossless(folder / "still.avi", {frames[0], frames[0], frames[0]}, 320, 240);
  expectRefusal(folder / "still.avi", "is a still image");
  writePictures(folder / "single", {coloured(frames, 320, 240)[0]}, ".png");
  expectRefusal(folder / "single", "one frame");
  expectRefusal(folder / "single/frame_0.png", "still image");
  expectRefusal(folder / "absent.mp4", "no such file");
  expectRefusal(folder.write("words.avi", "no video at all, just words"), "no video");
  std::filesystem::create_directories(folder / "empty");
  expectRefusal(folder / "empty", "manifest.json");
}

TEST_F(Reading, ATruncatedDicomIsRefused) {
  for (const DicomKind kind :
       {DicomKind::grey, DicomKind::rle, DicomKind::jpeg_baseline, DicomKind::jpeg_lossless}) {
    writeDicom(folder / "whole.dcm", frames, 320, 240, kind);
    const std::string bytes = bytesOf(folder / "whole.dcm");
    for (const double share : {0.3, 0.6, 0.95})
      expectRefusal(
          folder.write("cut.dcm",
                       bytes.substr(0, static_cast<std::size_t>(share * double(bytes.size())))),
          "truncated");
  }
}

TEST_F(Reading, ACodecThatIsNotKnownIsNamed) {
  std::string bytes = bytesOf(writeLossless(folder / "loop.avi", frames, 320, 240));
  for (std::size_t at = 0; (at = bytes.find("FFV1", at)) != std::string::npos;)
    bytes.replace(at, 4, "QQQQ");
  expectRefusal(folder.write("odd.avi", bytes), "codec");
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
  const Loop loop = readLoop(folder / "doppler", {}, true);
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

// A palette's greys, made of neighbours of opposite colours.
TEST_F(Reading, DitheredGreysAreGrey) {
  std::vector<cv::Mat> pictures = coloured(frames, 320, 240);
  for (cv::Mat& p : pictures)
    for (int y = 0; y < 240; ++y)
      for (int x = 0; x < 320; ++x) {
        cv::Vec3b& pixel = p.at<cv::Vec3b>(y, x);
        const int step = (x + y) % 2 ? 40 : -40, grey = pixel[0];
        if (grey < 60 || grey > 190) continue;
        pixel = {static_cast<std::uint8_t>(grey + step), static_cast<std::uint8_t>(grey),
                 static_cast<std::uint8_t>(grey - step)};
      }
  writePictures(folder / "dithered", pictures, ".png");
  const Video video = readVideo(folder / "dithered");
  const auto masked = std::count(video.coloured.begin(), video.coloured.end(), 1);
  EXPECT_LT(masked, 320 * 240 / 50);  // edges between dithered and plain greys
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
  const Loop loop = readLoop(folder / "png", side, true);
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
  const Loop loop = readLoop(folder / "flat", side, true);
  EXPECT_EQ(loop.video.height, 240);
  EXPECT_NEAR(loop.sector().r_max, drawing.sector.r_max, 3);
}

TEST_F(Reading, TheProgramEndsWithTwoAndOneLine) {
  writeLossless(folder / "loop.avi", drawing);
  writeLossless(folder / "still.avi", {frames[0], frames[0]}, 320, 240);
  const Outcome o = runShell("%B compare '" + (folder / "loop.avi").string() + "' '" +
                             (folder / "still.avi").string() + "' -o '" +
                             (folder / "out").string() + "' --quiet");
  EXPECT_EQ(o.code, 2);
  EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
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
}  // namespace echocine::compare
