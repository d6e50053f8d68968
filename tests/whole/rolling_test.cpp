// Lines that are acquired one after the other.

#include <gtest/gtest.h>

#include "core/parallel.h"
#include "frame/picture_grid.h"
#include "frame/simulator.h"
#include "motion/cycle/cardiac_clock.h"
#include "render/render.h"
#include "scene/scan_geometry.h"
#include "support/exr_planes.h"
#include "support/loop_scene.h"
#include "support/run_files.h"

namespace echocine {
namespace {

using namespace support;

constexpr double kRate_hz = 10;

class Rolling : public testing::Test {
 protected:
  // A ball that beats once in ten frames; its leaflet moves with it.
  SceneText ball() const {
    SceneText text = ballScene(10);
    text.acquisition["beats"] = "2";
    text.probe["samples"] = "256";
    text.output["channels"] = "[\"Y\", \"attenuation.A\", \"medium.id\"]";
    return text;
  }
  Scene scene(SceneText text, bool rolling, int together = 4) {
    text.acquisition["rolling"] = rolling ? "true" : "false";
    text.accuracy["rolling_lines"] = std::to_string(together);
    return readScene(writeBall(folder_, text));
  }
  TempFolder folder_;
};

// The instant of a line by the room's README.
double instantOf(int line, int lines, int together, double frame_s, double share = 1) {
  const int first = line / together * together, end = std::min(first + together, lines);
  return frame_s + (0.5 * (first + end) / lines - 0.5) * share / kRate_hz;
}

template <typename Plane>
auto samplesOf(const Plane& plane, int line, int samples) {
  const auto from = plane.begin() + std::ptrdiff_t{line} * samples;
  return std::vector(from, from + samples);
}

// What makes the law strong: it leaves nothing free.
TEST_F(Rolling, ALineIsByteForByteThatOfTheStillFrameAtItsInstant) {
  struct Way {
    std::string name, tracer, refraction, rays, extra, look;
    int together;
  };
  const std::string speckle = "[speckle]\non = true\n";
  for (const Way& way : {Way{"slice", "slice", "off", "1", "", "paper", 1},
                         Way{"slice, speckle", "slice", "off", "1", speckle, "paper", 5},
                         Way{"hierarchy, speckle", "embree", "off", "1", speckle, "paper", 8},
                         Way{"bent, speckle", "embree", "on", "1", speckle, "paper", 8},
                         Way{"bent beams, speckle", "auto", "on", "4", speckle, "paper", 8},
                         Way{"scanner", "auto", "off", "1", "", "scanner", 8},
                         Way{"lung", "auto", "off", "1", "", "scanner", 8},
                         Way{"lung, hierarchy", "embree", "off", "1", "", "scanner", 5}}) {
    SCOPED_TRACE(way.name);
    SceneText text = ball();
    if (way.name.starts_with("lung"))  // its surface moves
      text.structures.replace(text.structures.find("\"blood\""), 7, "\"lung\"");
    text.accuracy["tracer"] = "\"" + way.tracer + "\"";
    text.effects["refraction"] = "\"" + way.refraction + "\"";
    text.accuracy["rays_per_beam"] = way.rays;
    text.signal["look"] = "\"" + way.look + "\"";
    text.extra = way.extra;
    const Simulator still(scene(text, false)), rolling(scene(text, true, way.together));
    ASSERT_TRUE(rolling.plan().effects.rolling);
    ASSERT_FALSE(still.plan().effects.rolling);
    const int lines = still.scene().probe.lines, samples = still.scene().probe.samples;
    int different = 0;
    for (const double at_s : {0.2, 1.0}) {  // 1.0: across the beat's end
      const Frame rolled = rolling.frame(at_s), middle = still.frame(at_s);
      for (int line = 0; line < lines; line += way.together == 1 ? 5 : way.together / 2) {
        const Frame then = still.frame(instantOf(line, lines, way.together, at_s));
        const auto same = [&](const auto& a, const auto& b) {
          return samplesOf(a, line, samples) == samplesOf(b, line, samples);
        };
        EXPECT_TRUE(same(rolled.intensities, then.intensities)) << at_s << " line " << line;
        EXPECT_TRUE(same(rolled.medium, then.medium)) << at_s << " line " << line;
        for (const Channel c : {Channel::y, Channel::attenuation})
          EXPECT_TRUE(same(rolled.channels.at(c), then.channels.at(c))) << at_s << " " << line;
        different += same(rolled.intensities, middle.intensities) ? 0 : 1;
      }
      EXPECT_EQ(rolled.volumes_ml, middle.volumes_ml);
    }
    EXPECT_GT(different, 0);
  }
}

// The loop's first lines are acquired before its first frame's time: in the beat before.
TEST_F(Rolling, TheFirstFramesEarlyLinesAreOfABeatBefore) {
  for (const std::string variability : {"0.0", "0.2"}) {
    SceneText text = ball();
    text.acquisition["rr_variability"] = variability;
    const Simulator still(scene(text, false)), rolling(scene(text, true));
    const double beat_s = still.cardiacClock().at(0).beat_s;
    const double early_s = instantOf(0, 32, 4, 0);
    ASSERT_LT(early_s, 0);
    const FrameTime before = still.cardiacClock().atTime(early_s),
                    later = still.cardiacClock().atTime(beat_s + early_s);
    EXPECT_NEAR(before.phase, later.phase, 1e-9) << variability;
    const Frame rolled = rolling.frame(0), then = still.frame(beat_s + early_s);
    for (int k = 0; k < 256; ++k)
      ASSERT_NEAR(rolled.intensities[static_cast<std::size_t>(k)],
                  then.intensities[static_cast<std::size_t>(k)],
                  1e-3f * then.intensities[static_cast<std::size_t>(k)])
          << k;
  }
}

// Speckle and rolling lines know no seam between beats: from one frame to the next as much changes
// across the beat's end as beside it.
TEST_F(Rolling, BeatsAreContinuous) {
  for (const bool rolling : {false, true}) {
    SceneText text = ball();
    text.acquisition["frame_rate_hz"] = "200";
    text.signal["reference_intensity"] = "1e-6";
    text.extra = "[speckle]\non = true\nblood_time_ms = 100\ntissue_time_ms = 400\n";
    const Simulator simulator(scene(text, rolling));
    const auto at = [&](int frame) { return simulator.frame(frame / 200.0).greys.values; };
    std::vector<double> changes;
    std::vector<float> before = at(194);
    for (int frame = 195; frame <= 206; ++frame) {
      const std::vector<float> now = at(frame);
      double sum = 0;
      for (std::size_t i = 0; i < now.size(); ++i)
        sum += std::abs(double{now[i]} - double{before[i]});
      changes.push_back(sum / static_cast<double>(now.size()));
      before = now;
    }
    constexpr std::ptrdiff_t kSeam = 5;  // from frame 199 to 200
    const double seam = changes[kSeam];
    changes.erase(changes.begin() + kSeam);
    const auto [least, most] = std::minmax_element(changes.begin(), changes.end());
    EXPECT_GT(seam, 0.9 * *least) << rolling;
    EXPECT_LT(seam, 1.1 * *most) << rolling;
    EXPECT_LT(*most, 0.01);  // of other speckle it would be some 0.05
  }
}

TEST_F(Rolling, WhatStandsStillIsTheStillFrame) {
  SceneText text = SceneText::oneBox("myocardium");
  text.probe["lines"] = "24";
  writeObj(icosphere(2, 2.5).moved({0.3, 0.2, 6}), folder_ / "box.obj");
  for (const std::string extra : {"", "[speckle]\non = true\n"}) {
    text.extra = extra;
    const auto frame = [&](const std::string& rolling) {
      text.acquisition["rolling"] = rolling;
      text.accuracy["rolling_lines"] = "5";
      return Simulator(readScene(folder_.write("still.toml", text.text()))).frame(0.4);
    };
    const Frame still = frame("false"), rolled = frame("true");
    EXPECT_EQ(still.intensities, rolled.intensities);
    EXPECT_EQ(still.greys, rolled.greys);
    EXPECT_EQ(still.image.pixels, rolled.image.pixels);
  }
}

// A sheet across the beams that moves along them at v: line l meets it at z + v (t_l - t).
TEST_F(Rolling, APlateThatMovesAlongTheBeamsSlants) {
  constexpr int kKeys = 8, kLines = 33, kSamples = 2048;
  constexpr double kSpeed_cm_s = 6, kFrame_s = 0.2, kMost_cm = 8;
  SceneText text;
  for (int i = 0; i < kKeys; ++i)  // there in half the beat, and back
    writeObj(sheet(8, 6, kMost_cm - kSpeed_cm_s * std::abs(i / 8.0 - 0.5)),
             folder_ / ("plate_" + std::to_string(i) + ".obj"));
  text.structures =
      "[[structure]]\nname = \"plate\"\nmedium = \"valve\"\nmembrane = true\nkeyframes = "
      "\"plate_*.obj\"\n";
  text.probe["kind"] = "\"linear\"";
  text.probe.erase("sector_deg");
  text.probe["width_mm"] = "60";
  text.probe["lines"] = std::to_string(kLines);
  text.probe["samples"] = std::to_string(kSamples);
  text.motion["interpolation"] = "\"linear\"";
  text.acquisition["frame_rate_hz"] = "10";
  text.acquisition["rolling"] = "true";
  text.output["channels"] = "[\"reflection.Y\"]";
  for (const int together : {1, 4}) {
    for (const double share : {1.0, 0.4}) {
      text.accuracy["rolling_lines"] = std::to_string(together);
      text.acquisition["rolling_share"] = std::to_string(share);
      const Simulator rolling(readScene(folder_.write("plate.toml", text.text())));
      const Frame frame = rolling.frame(kFrame_s);
      const std::vector<float>& plane = frame.channels.at(Channel::reflection);
      const Probe& probe = rolling.scene().probe;
      for (int line = 0; line < kLines; ++line) {
        const std::vector<float> echo = samplesOf(plane, line, kSamples);
        const auto k =
            static_cast<double>(std::max_element(echo.begin(), echo.end()) - echo.begin());
        const double depth_m = probe.min_depth_m + (k + 0.5) * probe.sampleSpacing();
        const double at_s = instantOf(line, kLines, together, kFrame_s, share);
        const double expected_m = 1e-2 * (kMost_cm - kSpeed_cm_s * std::abs(at_s - 0.5));
        EXPECT_NEAR(depth_m, expected_m, 0.51 * probe.sampleSpacing()) << line;
      }
    }
  }
}

TEST_F(Rolling, TruthFollowsTheLines) {
  SceneText text = ball();
  text.output["channels"] = "[\"structure.id\", \"displacement.axial\", \"velocity.lateral\"]";
  text.extra = "[truth]\nwrite = [\"labels\", \"contours\"]\n";
  const Simulator still(scene(text, false)), rolling(scene(text, true));
  const int lines = still.scene().probe.lines, samples = still.scene().probe.samples;
  const double at_s = 0.3;
  const FrameTruth rolled = *rolling.frame(at_s).truth, middle = *still.frame(at_s).truth;
  const ScanGeometry geometry(still.scene().probe);
  const PictureGrid grid = pictureGrid(still.scene());
  std::size_t seen = 0, moved = 0;
  for (int first = 0; first < lines; first += 4) {
    const FrameTruth then = *still.frame(instantOf(first, lines, 4, at_s)).truth;
    for (int line = first; line < first + 4; ++line) {
      EXPECT_EQ(samplesOf(rolled.sample_ids, line, samples),
                samplesOf(then.sample_ids, line, samples));
      for (const Channel c : {Channel::displacement_axial, Channel::velocity_lateral})
        for (int k = 0; k < samples; ++k) {
          const auto at = static_cast<std::size_t>(line * samples + k);
          const float a = rolled.values(c)[at], b = then.values(c)[at];
          ASSERT_TRUE(a == b || (std::isnan(a) && std::isnan(b))) << line << " " << k;
        }
    }
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) {
        const auto place = geometry.beamPosition(grid.xOf(column), grid.zOf(row));
        if (!place || std::lround(place->line) / 4 != first / 4) continue;
        const auto pixel = static_cast<std::size_t>(row * grid.width + column);
        ++seen;
        moved += rolled.labels[pixel] != middle.labels[pixel] ? 1 : 0;
        ASSERT_EQ(rolled.labels[pixel], then.labels[pixel]) << row << " " << column;
      }
  }
  EXPECT_GT(seen, 1000u);
  EXPECT_GT(moved, 5u);
  ASSERT_EQ(rolled.contours.size(), middle.contours.size());  // those of the frame's time
  for (std::size_t c = 0; c < middle.contours.size(); ++c)
    EXPECT_TRUE(rolled.contours[c].points_m == middle.contours[c].points_m);
}

TEST_F(Rolling, FilesAreThoseOfAnyThreadsOfAResumedRunAndOfTheSimulator) {
  SceneText text = ball();
  text.acquisition["beats"] = "0.5";
  text.output["channels"] = "[\"Y\", \"display.Y\"]";
  text.extra = "[speckle]\non = true\n[artefacts]\npersistence = 0.3\n";
  const Scene rolling = scene(text, true, 8);
  renderLoop(rolling, {.folder = folder_ / "one", .threads = 1, .frames = {}}, {});
  renderLoop(rolling, {.folder = folder_ / "four", .threads = 4, .frames = {}}, {});
  const std::map<std::string, std::string> files = lastingFiles(folder_ / "one");
  EXPECT_EQ(files, lastingFiles(folder_ / "four"));
  std::filesystem::remove(folder_ / "four/manifest.json");
  std::filesystem::remove(folder_ / "four/intensity/frame_0002.exr");
  renderLoop(rolling, {.folder = folder_ / "four", .threads = 2, .frames = {}, .resume = true}, {});
  EXPECT_EQ(files, lastingFiles(folder_ / "four"));

  const Frame frame = Simulator(rolling).frame(0.2);
  const ExrPlane written = exrPlane(folder_ / "one/intensity/frame_0002.exr", "display.Y");
  for (int line = 0; line < frame.lines; ++line)
    for (int k = 0; k < frame.samples; ++k)
      ASSERT_EQ(written.bits[static_cast<std::size_t>(k * frame.lines + line)],
                std::bit_cast<std::uint32_t>(
                    frame.greys[static_cast<std::size_t>(line * frame.samples + k)]));
}

TEST_F(Rolling, NumbersOutOfRangeNameTheirKeyInOneLine) {
  const std::pair<std::string, std::string> wrong[] = {
      {"rolling", "1"}, {"rolling_share", "0"}, {"rolling_share", "1.5"}, {"rolling_share", "nan"}};
  for (const auto& [key, value] : wrong) {
    SceneText text = SceneText::oneBox("blood");
    text.acquisition[key] = value;
    const std::string message = refusalOf(text.text());
    EXPECT_NE(message.find(": acquisition." + key + ": is "), std::string::npos) << message;
    EXPECT_NE(message.find("accepted: "), std::string::npos) << message;
  }
  SceneText text = SceneText::oneBox("blood");
  text.accuracy["rolling_lines"] = "0";
  EXPECT_NE(refusalOf(text.text()).find("accuracy.rolling_lines: is 0, accepted: "),
            std::string::npos);
}

}  // namespace
}  // namespace echocine
