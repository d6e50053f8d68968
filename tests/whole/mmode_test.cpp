// M-mode: one line over time.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/parallel.h"
#include "mmode/echo_trace.h"
#include "mmode/mmode_files.h"
#include "scene/scan_geometry.h"
#include "support/loop_scene.h"
#include "support/moving_plate.h"
#include "support/paths.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;

SceneText ball() {
  SceneText text = ballScene(10);
  text.acquisition["beats"] = "2";
  text.probe["samples"] = "256";
  return text;
}

// Every column is byte for byte the line of a still frame at its instant.
TEST(MMode, AColumnIsTheLineOfAStillFrame) {
  struct Way {
    std::string name, look, tracer, refraction, rays, extra;
  };
  for (const Way& way : {Way{"paper", "paper", "auto", "auto", "1", ""},
                         Way{"scanner", "scanner", "auto", "off", "1", ""},
                         Way{"persistence", "portable", "auto", "off", "1", ""},
                         Way{"edges", "sharp", "auto", "off", "1", ""},
                         Way{"hierarchy", "paper", "embree", "off", "1", "[speckle]\non = true\n"},
                         Way{"bent beams", "paper", "auto", "on", "4", "[speckle]\non = true\n"}}) {
    SCOPED_TRACE(way.name);
    SceneText text = ball();
    text.signal["look"] = "\"" + way.look + "\"";
    if (way.name == "edges") text.probe["lines"] = "96";  // so that the window has neighbours
    text.accuracy["tracer"] = "\"" + way.tracer + "\"";
    text.accuracy["rays_per_beam"] = way.rays;
    text.effects["refraction"] = "\"" + way.refraction + "\"";
    text.extra = way.extra;
    TempFolder folder;
    const Scene scene = readScene(writeBall(folder, text));
    MModeRequest request;
    request.rate_hz = 25;
    const Simulator simulator(mmodeScene(scene, request));
    const int lines = scene.probe.lines, samples = scene.probe.samples;
    for (const int line : {0, lines / 3, lines - 1}) {
      const ScanGeometry geometry(scene.probe);
      request.place = geometry.firstPlace() + line * geometry.cellWidth();
      const MMode mode = makeMMode(simulator, request);
      ASSERT_EQ(mode.line, line);
      ASSERT_EQ(mode.columns, 50);
      for (const int t : {0, 13, 35}) {
        const Frame frame = simulator.frame(t / request.rate_hz);
        const auto at = [&](const auto& plane, std::ptrdiff_t first) {
          return std::vector<float>(plane.begin() + first * samples,
                                    plane.begin() + (first + 1) * samples);
        };
        EXPECT_EQ(at(mode.intensities, t), at(frame.intensities, line)) << t;
        EXPECT_EQ(at(mode.greys, t), at(frame.greys, line)) << t;
      }
    }
  }
}

// A plate of 1 mm that moves along the central line as z = 60 mm - 8 mm (1 - cos(2 pi phase)) / 2:
// its border is where the closed form says, and the echo is followed by its motion.
TEST(MMode, AMovingPlateIsWhereItsClosedFormSays) {
  constexpr int kPlateFrames = 40;
  constexpr double kStroke_mm = 8;
  const auto up_mm = [&](double phase) {
    return 0.5 * kStroke_mm * (1 - std::cos(2 * std::numbers::pi * phase));
  };
  TempFolder folder;
  writePlates(folder, kPlateFrames, kStroke_mm, 0.1);
  for (const bool speckle : {false, true}) {
    SCOPED_TRACE(speckle ? "speckle" : "smooth");
    SceneText text;
    text.background = "blood";
    text.probe["lines"] = "33";
    text.probe["samples"] = "480";
    text.motion["interpolation"] = "\"fourier\"";
    text.acquisition["beats"] = "2";
    text.addStructure("plate", "myocardium", "\"plate_*.obj\"");
    if (speckle) text.extra = "[speckle]\non = true\n";
    const Scene scene = readScene(folder.write("scene.toml", text.text()));
    MModeRequest request;
    request.rate_hz = 200;
    const Simulator simulator(mmodeScene(scene, request));
    const MMode mode = makeMMode(simulator, request);
    ASSERT_EQ(mode.columns, 400);
    ASSERT_EQ(mode.borders.size(), 800u);
    for (std::size_t i = 0; i < mode.borders.size(); ++i) {
      const BorderCrossing& border = mode.borders[i];
      const double phase = mode.times[static_cast<std::size_t>(border.column)].phase;
      EXPECT_NEAR(1e3 * border.depth_m, 60 - up_mm(phase) + (i % 2 == 0 ? 0 : 1), 0.002) << i;
    }
    // The near face of the plate; saturated greys hide its place by up to the length of a pulse.
    constexpr double kPulse_mm = 0.62;  // 2 cycles at 2.5 MHz
    const std::vector<double> moved =
        followEcho({mode.greys, mode.columns, mode.samples, scene.probe.sampleSpacing(), 0.005},
                   0.060 - scene.probe.min_depth_m);
    for (int t = 0; t < mode.columns; ++t)
      EXPECT_NEAR(1e3 * moved[static_cast<std::size_t>(t)],
                  up_mm(mode.times[static_cast<std::size_t>(t)].phase), kPulse_mm)
          << t;
  }
}

// A bright line on a dark ground is followed by fractions of a sample, up to 0.4 m/s.
TEST(MMode, ABrightLineIsFollowedByFractionsOfASample) {
  constexpr int kLineColumns = 60, kLineSamples = 400;
  constexpr double kLineSample_m = 2e-4, kLineColumn_s = 0.005;
  for (const double velocity : {0.0, 0.013, 0.1, -0.25}) {
    std::vector<float> greys;
    for (int t = 0; t < kLineColumns; ++t)
      for (int k = 0; k < kLineSamples; ++k) {
        const double from_line = ((k + 0.5) * kLineSample_m -
                                  (0.04 - 0.02 * std::sin(velocity * t * kLineColumn_s / 0.02))) /
                                 1e-3;
        greys.push_back(static_cast<float>(0.2 + 0.7 * std::exp(-0.5 * from_line * from_line)));
      }
    const std::vector<double> moved =
        followEcho({greys, kLineColumns, kLineSamples, kLineSample_m, kLineColumn_s}, 0.041);
    for (int t = 0; t < kLineColumns; ++t)
      EXPECT_NEAR(moved[static_cast<std::size_t>(t)],
                  0.02 * std::sin(velocity * t * kLineColumn_s / 0.02), 5e-6)
          << velocity << " " << t;
  }
}

// TAPSE of the shipped heart: along the line the ring moves as the picture shows.
TEST(HeartMMode, TheShippedHeartsRingMovesAsItsPictureShows) {
  const TempFolder folder;
  const std::string scene =
      (std::filesystem::path(kSourceDir) / "examples/beating_heart/scene.toml").string();
  MModeOptions options;
  options.request.through = MModeTarget::tricuspid_lateral;
  options.request.rate_hz = 100;
  options.folder = folder / "tapse";
  const MMode mode = writeMMode(readScene(scene), options);
  ASSERT_TRUE(mode.ring);
  EXPECT_GT(mode.ring->exact_mm, 15);
  EXPECT_NEAR(mode.ring->exact_mm, mode.ring->in_space_mm, 5);
  EXPECT_NEAR(mode.ring->traced_mm, mode.ring->exact_mm, 4);
  std::printf("[ MEASURED ] TAPSE on the line %.1f mm, traced %.1f mm, in space %.1f mm\n",
              mode.ring->exact_mm, mode.ring->traced_mm, mode.ring->in_space_mm);
  for (const char* name : {"mmode.exr", "mmode.png", "borders.csv", "ring.csv", "mmode.json"})
    EXPECT_GT(std::filesystem::file_size(options.folder / name), 100u) << name;
}

TEST(MMode, TheBytesDoNotDependOnThreads) {
  TempFolder folder;
  SceneText text = ball();
  text.signal["look"] = "\"scanner\"";
  const Scene scene = readScene(writeBall(folder, text));
  std::string first;
  for (const int threads : {1, 2, 5}) {
    MModeOptions options;
    options.request.rate_hz = 40;
    options.threads = threads;
    options.folder = folder / ("t" + std::to_string(threads));
    writeMMode(scene, options);
    std::string all;
    for (const char* name : {"mmode.exr", "mmode.png", "borders.csv", "mmode.json"})
      all += bytesOf(options.folder / name);
    if (first.empty()) first = all;
    EXPECT_EQ(all, first) << threads;
  }
}

// A line outside the sector is refused before an earlier M-mode is touched.
TEST(MMode, ARefusedRunLeavesTheEarlierOne) {
  TempFolder folder;
  const Scene scene = readScene(writeBall(folder, ball()));
  MModeOptions options;
  options.request.rate_hz = 20;
  options.folder = folder / "out";
  writeMMode(scene, options);
  const std::string whole = bytesOf(options.folder / "mmode.json");
  folder.write("out/ring.csv", "of another line");
  options.request.place = 1;  // rad
  EXPECT_THROW(writeMMode(scene, options), SceneError);
  EXPECT_EQ(bytesOf(options.folder / "mmode.json"), whole);
  options.request.place.reset();
  writeMMode(scene, options);
  EXPECT_EQ(bytesOf(options.folder / "mmode.json"), whole);
  EXPECT_FALSE(std::filesystem::exists(options.folder / "ring.csv"));
}

TEST(MMode, RefusesWhatItCannotShowInOneLine) {
  TempFolder folder;
  const std::string scene = writeBall(folder, ball()).string();
  const auto refusal = [&](const std::string& options) {
    const Outcome o =
        runShell("%B mmode '" + scene + "' -o '" + (folder / "out").string() + "' " + options);
    EXPECT_EQ(o.code, 2) << options << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "out" / "mmode.json"));
    return o.err;
  };
  EXPECT_NE(refusal("--angle 40").find("accepted: -35 to 35 degrees"), std::string::npos);
  EXPECT_NE(refusal("--offset 3").find("use --angle"), std::string::npos);
  EXPECT_NE(refusal("--rate 0").find("accepted: 1 to 6416 Hz"), std::string::npos);
  EXPECT_NE(refusal("--rate nan").find("--rate"), std::string::npos);
  EXPECT_NE(refusal("--through mitral-tips").find("role lv_"), std::string::npos);
  refusal("--through nowhere");
  SceneText text = ball();
  text.probe["lines"] = "1";
  writeBall(folder, text);
  EXPECT_NE(refusal("--angle 85").find("outside the sector"), std::string::npos);
  const Outcome one =
      runShell("%B mmode '" + scene + "' -o '" + (folder / "one").string() + "' --rate 10 --quiet");
  ASSERT_EQ(one.code, 0) << one.err;
  EXPECT_NE(bytesOf(folder / "one/mmode.json").find("\"angle_deg\": 0.0"), std::string::npos);
  refusal("--angle 0 --through mitral-tips");
}

}  // namespace
}  // namespace echocine
