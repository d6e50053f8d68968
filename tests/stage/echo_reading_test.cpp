// Every kind of file that a loop comes in, written by its own library and read back; and every kind
// of file that is none.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "support/loop_reading.h"
#include "support/run_program.h"
#include "video/read_video.h"

namespace echocine::echo {
namespace {

using namespace support;

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
  folder.write("png/._frame_3.png", "attributes that a file system keeps");
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
  const auto region = [](int factor, bool whole = false) {
    return [factor, whole](DcmDataset& data) {
      DcmItem* item = nullptr;
      data.findOrCreateSequenceItem(DCM_SequenceOfUltrasoundRegions, item);
      item->putAndInsertUint16(DCM_RegionDataType, 1);
      // Some scanners give the end behind the last pixel.
      const std::array<Uint32, 4> box =
          whole ? std::array<Uint32, 4>{0, 0, 320, 240} : std::array<Uint32, 4>{10, 2, 310, 232};
      const DcmTagKey keys[4] = {DCM_RegionLocationMinX0, DCM_RegionLocationMinY0,
                                 DCM_RegionLocationMaxX1, DCM_RegionLocationMaxY1};
      for (std::size_t i = 0; i < 4; ++i)
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
    const EchoLoop loop = readLoop(file, {}, true);
    ASSERT_TRUE(loop.metres_per_pixel) << factor;
    EXPECT_NEAR(*loop.metres_per_pixel, 7e-4, 1e-9) << factor;
    EXPECT_EQ(loop.video.notes.empty(), factor == 1);
  }
  writeDicom(folder / "whole.dcm", frames, 320, 240, DicomKind::grey, region(1, true));
  const EchoLoop whole = readLoop(folder / "whole.dcm", {}, true);
  EXPECT_NEAR(whole.metres_per_pixel.value_or(0), 7e-4, 1e-9);
  EXPECT_TRUE(whole.video.notes.empty());
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
  expectRefusal(folder.write("words.avi", "no video at all, just words"), "not a readable video");
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

// Greys spread over a palette of few colours by FFmpeg, as loops of the web have them.
TEST_F(Reading, GreysOfAPaletteOfColoursAreGrey) {
  Drawing d = drawing;
  d.frames = 24;
  d.noise = 8;
  writePictures(folder / "png", coloured(drawnLoop(d), 320, 240), ".png");
  const std::string out = (folder / "palette.gif").string();
  for (const char* how :
       {"", "-vf 'split[a][b];[a]palettegen=max_colors=64[p];[b][p]paletteuse=dither=sierra2_4a'",
        "-vf 'format=rgb8,format=rgb24,split[a][b];[a]palettegen=max_colors=256[p];"
        "[b][p]paletteuse=dither=bayer'"}) {
    SCOPED_TRACE(how);
    if (runShell("ffmpeg -v error -y -framerate 25 -i '" + (folder / "png/frame_%d.png").string() +
                 "' " + how + " '" + out + "'")
            .code != 0)
      GTEST_SKIP() << "no ffmpeg";
    const EchoLoop loop = readLoop(out, {}, true);
    EXPECT_NEAR(loop.sector().r_max, drawing.sector.r_max, 4);
    double inside = 0, masked = 0;
    for (int y = 0; y < 240; ++y)
      for (int x = 0; x < 320; ++x)
        if (loop.sector().contains(x + 0.5, y + 0.5))
          ++inside, masked += loop.video.coloured[static_cast<std::size_t>(y * 320 + x)];
    EXPECT_LT(masked, 0.05 * inside);
  }
}

// A copy that stopped half-way: what is there is read, and how much is missing is said.
TEST_F(Reading, AFilmThatIsCutOffSaysSo) {
  Drawing d = drawing;
  d.frames = 24;
  writePictures(folder / "png", coloured(drawnLoop(d), 320, 240), ".png");
  for (const auto& [name, how] :
       {std::pair("film.avi", "-c:v mjpeg -q:v 2"), std::pair("film.gif", "")}) {
    const std::string whole = (folder / name).string();
    if (runShell("ffmpeg -v error -y -framerate 25 -i '" + (folder / "png/frame_%d.png").string() +
                 "' " + how + " '" + whole + "'")
            .code != 0)
      GTEST_SKIP() << "no ffmpeg";
    const auto told = [](const Video& v) {
      return std::count_if(v.notes.begin(), v.notes.end(), [](const std::string& note) {
        return note.find("cut off") != std::string::npos;
      });
    };
    EXPECT_EQ(told(readVideo(whole)), 0) << name;
    const std::string bytes = bytesOf(whole);
    for (const double share : {0.45, 0.5, 0.55, 0.6}) {
      const auto cut = folder.write(
          std::string("cut_") + name,
          bytes.substr(0, static_cast<std::size_t>(share * static_cast<double>(bytes.size()))));
      const Video video = readVideo(cut);
      EXPECT_LT(video.frameCount(), 24) << name << ' ' << share;
      EXPECT_GT(video.frameCount(), 8) << name << ' ' << share;
      EXPECT_EQ(told(video), 1) << name << ' ' << share;
    }
  }
}

// A file that ends between two clusters of Matroska decodes without an error.
TEST_F(Reading, AFilmThatIsCutOffAtAClusterSaysSo) {
  Drawing d = drawing;
  d.frames = 24;
  writePictures(folder / "png", coloured(drawnLoop(d), 320, 240), ".png");
  const std::string whole = (folder / "film.mkv").string();
  if (runShell("ffmpeg -v error -y -framerate 25 -i '" + (folder / "png/frame_%d.png").string() +
               "' -c:v mjpeg -q:v 2 -cluster_time_limit 200 '" + whole + "'")
          .code != 0)
    GTEST_SKIP() << "no ffmpeg";
  EXPECT_TRUE(readVideo(whole).notes.empty());
  const std::string bytes = bytesOf(whole), cluster = "\x1f\x43\xb6\x75";
  std::vector<std::size_t> starts;  // a cluster for each frame
  for (std::size_t at = bytes.find(cluster); at != std::string::npos;
       at = bytes.find(cluster, at + 4))
    starts.push_back(at);
  ASSERT_EQ(starts.size(), 24u);
  for (const std::size_t kept : {2, 5, 12, 20}) {
    const Video video = readVideo(folder.write("cut.mkv", bytes.substr(0, starts[kept])));
    EXPECT_EQ(video.frameCount(), static_cast<int>(kept));
    ASSERT_EQ(video.notes.size(), 1u) << kept;
    EXPECT_NE(video.notes[0].find(fmt::format("it is cut off: {:.2f} s of the 0.96 s in its header",
                                              0.04 * static_cast<double>(kept))),
              std::string::npos)
        << video.notes[0];
  }
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

}  // namespace
}  // namespace echocine::echo
