// Loops as MP4, GIF and WebP: pixels, times and sizes of what is read back, and refused input.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/error.h"
#include "core/hash_random.h"
#include "core/parallel.h"
#include "export/export_loops.h"
#include "export/montage.h"
#include "support/echo_video.h"
#include "support/run_program.h"
#include "support/temp_folder.h"
#include "video/read_video.h"
#include "video/video_builder.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

// Blobs that move, with one pixel of each grey level in the first rows.
GreyImage pictureOf(int width, int height, int frame) {
  GreyImage image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double wave = std::sin(0.2 * x + 0.4 * frame) * std::cos(0.17 * y - 0.3 * frame);
      image.pixels.push_back(static_cast<std::uint8_t>(std::lround(127.5 + 127.5 * wave)));
    }
  for (std::size_t g = 0; g < 256 && g < image.pixels.size(); ++g)
    image.pixels[g] = static_cast<std::uint8_t>(g);
  return image;
}

// The folder of a render, as far as an export reads it.
fs::path render(const fs::path& folder, int frames, double rate_hz) {
  fs::create_directories(folder);
  std::vector<PixelPlane> planes;
  for (int i = 0; i < frames; ++i) planes.push_back(pictureOf(64, 48, i).pixels);
  writeLossless(folder / "cine.avi", planes, 64, 48, rate_hz);
  writeManifestOfCine(folder);
  return folder;
}

Exported exported(const std::vector<fs::path>& loops, const fs::path& output,
                  ExportOptions options = {}) {
  options.loops = loops;
  options.output = output;
  return exportLoops(options);
}

double meanDifference(const PixelPlane& a, const std::vector<std::uint8_t>& b) {
  EXPECT_EQ(a.size(), b.size());
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(double(a[i]) - double(b[i]));
  return sum / static_cast<double>(a.size());
}

TEST(Export, AGifHasEveryPixelOfTheLoop) {
  TempFolder folder;
  const Exported made = exported({render(folder / "loop", 12, 25)}, folder / "loop.gif");
  EXPECT_EQ(made.codec, "GIF");
  EXPECT_EQ(made.frames, 12);
  const Video video = readVideo(folder / "loop.gif");
  ASSERT_EQ(video.frameCount(), 12);
  EXPECT_NEAR(video.rate.hz, 25, 1e-9);
  for (int i = 0; i < 12; ++i)
    EXPECT_EQ(video.frames[static_cast<std::size_t>(i)], pictureOf(64, 48, i).pixels) << i;
}

TEST(Export, AnMp4RepeatsTheLoopWithinTheLossOfItsCodec) {
  TempFolder folder;
  ExportOptions options;
  options.repeats = 3;
  const fs::path loop = render(folder / "loop", 12, 25);
  const Exported made = exported({loop}, folder / "loop.mp4", options);
  EXPECT_TRUE(made.codec == "H.264" || made.codec == "MPEG-4 part 2") << made.codec;
  const Video video = readVideo(folder / "loop.mp4");
  ASSERT_EQ(video.frameCount(), 36);
  EXPECT_NEAR(video.rate.hz, 25, 1e-9);
  for (std::size_t i = 0; i < 36; ++i)
    EXPECT_LT(meanDifference(video.frames[i], pictureOf(64, 48, static_cast<int>(i % 12)).pixels),
              4)
        << i;
  // The same bytes again, with other threads.
  options.threads = 1;
  exported({loop}, folder / "again.mp4", options);
  EXPECT_EQ(bytesOf(folder / "again.mp4"), bytesOf(folder / "loop.mp4"));
}

// By the specification of the container: 12 frames (ANMF) of 40 ms, repeated without end (ANIM).
TEST(Export, AWebpHasTheFramesAndTimesOfTheLoop) {
  TempFolder folder;
  exported({render(folder / "loop", 12, 25)}, folder / "loop.webp");
  const std::string bytes = bytesOf(folder / "loop.webp");
  ASSERT_EQ(bytes.substr(0, 4) + bytes.substr(8, 4), "RIFFWEBP");
  const auto number = [&](std::size_t at, int count) {
    unsigned value = 0;
    for (int i = count; i-- > 0;)
      value = value << 8 | static_cast<unsigned char>(bytes.at(at + static_cast<std::size_t>(i)));
    return value;
  };
  int frames = 0;
  unsigned duration_ms = 0;
  for (std::size_t at = 12; at + 8 <= bytes.size();) {
    const std::string kind = bytes.substr(at, 4);
    if (kind == "VP8X") {
      EXPECT_EQ(number(at + 12, 3), 63u);  // width - 1
      EXPECT_EQ(number(at + 15, 3), 47u);
    } else if (kind == "ANIM") {
      EXPECT_EQ(number(at + 12, 2), 0u);
    } else if (kind == "ANMF") {
      ++frames;
      duration_ms += number(at + 20, 3);
    }
    const unsigned size = number(at + 4, 4);
    at += 8 + size + size % 2;
  }
  EXPECT_EQ(frames, 12);
  EXPECT_NEAR(duration_ms, 480, 1);
}

// A faster loop than the format shows keeps its duration and loses frames.
TEST(Export, DurationStaysWhereFramesAreLeftOut) {
  TempFolder folder;
  const fs::path loop = render(folder / "loop", 100, 100);
  const Exported fast = exported({loop}, folder / "fast.gif");
  EXPECT_EQ(fast.frames, 50);
  EXPECT_EQ(fast.notes.size(), 1u);
  const Video video = readVideo(folder / "fast.gif");
  ASSERT_EQ(video.frameCount(), 50);
  for (std::size_t i = 0; i < 50; ++i)
    EXPECT_EQ(video.frames[i], pictureOf(64, 48, static_cast<int>(2 * i + 1)).pixels) << i;
  ExportOptions options;
  options.speed = 0.25;
  const Exported slow = exported({loop}, folder / "slow.gif", options);
  EXPECT_EQ(slow.frames, 100);
  EXPECT_NEAR(slow.frame_rate_hz, 25, 1e-9);
  EXPECT_TRUE(slow.notes.empty());
}

// Cells are filled by rows; each loop keeps its shape, and shows the frame of its own phase.
TEST(Export, AMontageShowsAllLoopsAtOnePhase) {
  const auto loopOf = [](int frames, int width, int height, std::uint8_t first) {
    MontageLoop loop;
    for (int i = 0; i < frames; ++i)
      loop.frames.push_back({width, height,
                             std::vector<std::uint8_t>(static_cast<std::size_t>(width * height),
                                                       static_cast<std::uint8_t>(first + i))});
    return loop;
  };
  const TempFolder folder;
  const auto montageOf = [&](std::vector<MontageLoop> loops, int columns, int width) {
    auto montage = std::make_unique<Montage>(loops.size(), columns, width, folder.path());
    for (MontageLoop& loop : loops) montage->add(std::move(loop));
    return montage;
  };
  withThreads(2, [&] {
    const auto made =
        montageOf({loopOf(10, 40, 30, 20), loopOf(20, 20, 30, 100), loopOf(7, 80, 20, 200)}, 0, 0);
    const Montage& montage = *made;
    EXPECT_TRUE(fs::is_empty(folder.path()));  // its file has no name
    EXPECT_EQ(montage.width(), 80);
    EXPECT_EQ(montage.height(), 60);
    for (int i = 0; i < 40; ++i) {
      const double phase = (i + 0.5) / 40;
      const GreyImage picture = montage.at(phase);
      const auto at = [&](int x, int y) {
        return int(picture.pixels[static_cast<std::size_t>(y * picture.width + x)]);
      };
      EXPECT_EQ(at(20, 15), 20 + int(phase * 10));
      EXPECT_EQ(at(60, 15), 100 + int(phase * 20));  // 20 wide, centred in 40
      EXPECT_EQ(at(49, 15), 0);
      EXPECT_EQ(at(50, 15), 100 + int(phase * 20));
      EXPECT_EQ(at(20, 45), 200 + int(phase * 7));  // 80 x 20 shrinks to 40 x 10
      EXPECT_EQ(at(20, 39), 0);
      EXPECT_EQ(at(60, 45), 0);  // no fourth loop
    }
    EXPECT_EQ(montageOf({loopOf(2, 41, 31, 20)}, 0, 0)->width(), 42);  // even
    EXPECT_EQ(montageOf({loopOf(2, 40, 30, 0), loopOf(2, 40, 30, 0)}, 1, 20)->height(), 30);
    EXPECT_THROW(
        montageOf({loopOf(2, 4000, 30, 0), loopOf(2, 40, 30, 0), loopOf(2, 40, 30, 0)}, 3, 0),
        SceneError);
  });
}

TEST(Export, ATintKeepsTheOrderOfGreys) {
  for (const auto& tint : NamesOf<Tint>::kAll) {
    const GreyColours colours = coloursOf(tint.value);
    EXPECT_EQ(colours[0].red + colours[0].green + colours[0].blue, 0);
    EXPECT_EQ(colours[255].red + colours[255].green + colours[255].blue, 3 * 255);
    for (std::size_t g = 1; g < 256; ++g) {
      EXPECT_GE(colours[g].red, colours[g - 1].red);
      EXPECT_GE(colours[g].green, colours[g - 1].green);
      EXPECT_GE(colours[g].blue, colours[g - 1].blue);
    }
  }
  TempFolder folder;
  ExportOptions options;
  options.tint = Tint::sepia;
  exported({render(folder / "loop", 4, 25)}, folder / "loop.gif", options);
  const Video video = readVideo(folder / "loop.gif");
  const GreyColours colours = coloursOf(Tint::sepia);
  const GreyImage first = pictureOf(64, 48, 0);
  for (std::size_t i = 0; i < first.pixels.size(); ++i) {
    const PaletteColour c = colours[first.pixels[i]];
    EXPECT_NEAR(video.frames[0][i], lumaOf(c.red, c.green, c.blue), 1);
  }
}

// Text beside the sector of a video may name a patient, also in a folder that looks like a render.
TEST(Export, OfAVideoOnlyTheSectorIsShown) {
  TempFolder folder;
  Drawing drawing;
  std::vector<PixelPlane> frames = drawnLoop(drawing);
  for (PixelPlane& frame : frames)
    for (std::size_t y = 2; y < 12; ++y)
      for (std::size_t x = 2; x < 60; ++x)
        frame[y * static_cast<std::size_t>(drawing.width) + x] = x % 7 < 3 ? 255 : 0;
  writeLossless(folder / "real.avi", frames, drawing.width, drawing.height);
  fs::create_directories(folder / "stopped");
  fs::create_directories(folder / "scanner");
  render(folder / "replaced", 4, 25);
  for (const char* name : {"stopped", "scanner", "replaced"})
    fs::copy_file(folder / "real.avi", folder / name / "cine.avi",
                  fs::copy_options::overwrite_existing);
  folder.write("scanner/manifest.json", "{\n \"files\": {}\n}\n");
  for (const char* name : {"real.avi", "stopped", "scanner", "replaced"}) {
    SCOPED_TRACE(name);
    exported({folder / name}, folder / "real.gif");
    const Video video = readVideo(folder / "real.gif");
    const auto at = [&](int x, int y) {
      return int(video.frames[3][static_cast<std::size_t>(y * drawing.width + x)]);
    };
    int text = 0;
    for (int y = 2; y < 12; ++y)
      for (int x = 2; x < 60; ++x) text += at(x, y);
    EXPECT_EQ(text, 0);
    EXPECT_EQ(at(160, 120), int(frames[3][static_cast<std::size_t>(120 * drawing.width + 160)]));
  }
}

TEST(Export, UnusableArgumentsEndInOneLine) {
  TempFolder folder;
  const std::string loop = "'" + render(folder / "loop", 4, 25).string() + "'",
                    out = "'" + (folder / "out").string();
  fs::create_directories(folder / "frames");
  fs::copy_file(folder / "loop/cine.avi", folder / "copy.mp4");
  const std::pair<std::string, std::string> kCases[] = {
      {loop + " -o " + out + ".mov'", "accepted: .mp4, .gif, .webp"},
      {loop + " -o " + out + ".gif' --captions a b", "2 for 1 loops"},
      {loop + " -o " + out +
           ".gif' --captions Vorh\xc3\xb6"
           "fe",
       "cannot be drawn"},
      {loop + " -o " + out + ".gif' --speed 0", "--speed: 0"},
      {loop + " -o " + out + ".gif' --speed nan", "--speed"},
      {loop + " -o " + out + ".gif' --width 5", "--width: 5"},
      {loop + " -o " + out + ".gif' --repeats 0", "--repeats: 0"},
      {loop + " -o " + out + ".gif' --tint green", "--tint"},
      {loop + " -o '" + (folder / "none/out.gif").string() + "'", "out.gif"},
      {"'" + (folder / "frames").string() + "' -o " + out + ".gif'", "frames"},
      {"'" + (folder / "copy.mp4").string() + "' -o '" + (folder / "copy.mp4").string() + "'",
       "write to another file"}};
  for (const auto& [arguments, words] : kCases) {
    SCOPED_TRACE(arguments);
    const Outcome outcome = runShell("%B export " + arguments);
    EXPECT_TRUE(outcome.code == 1 || outcome.code == 2) << outcome.code;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    for (const char* left : {"out.gif", "out.mov"}) EXPECT_FALSE(fs::exists(folder / left));
  }
}

}  // namespace
}  // namespace echocine
