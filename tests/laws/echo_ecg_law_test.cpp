// R waves that were drawn are read from the picture to within a frame, and none where none were.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "echo/ecg_trace.h"
#include "echo/ecg_waves.h"
#include "support/all_cases.h"
#include "support/drawn_ecg.h"
#include "support/paths.h"

namespace echocine::echo {
namespace {

using namespace support;

const char* nameOf(EcgKind kind) {
  return kind == EcgKind::sweeping    ? "sweeping"
         : kind == EcgKind::scrolling ? "scrolling"
                                      : "still, with a marker";
}

// Every R wave of the loop but those of its last three frames, where a head hides them, is found
// within a frame, and nothing else in the loop.
void expectWaves(const EcgTrace& trace, const DrawnEcg& e, const std::string& what, double size) {
  double worst = 0;
  for (const double r : e.r_s) {
    const double frame = r * e.fps;
    if (frame < 0.5 || frame > e.frames - 4) continue;
    double off = 1e9;
    for (const double found : trace.r_frames) off = std::min(off, std::abs(found - frame));
    EXPECT_LT(off, 1) << what << ": R wave at frame " << frame;
    worst = std::max(worst, off);
  }
  for (const double found : trace.r_frames) {
    if (found < 0 || found > e.frames - 1) continue;
    double off = 1e9;
    for (const double r : e.r_s) off = std::min(off, std::abs(found - r * e.fps));
    EXPECT_LT(off, 1) << what << ": found at frame " << found;
  }
  EXPECT_EQ(trace.kind, nameOf(e.kind)) << what;
  EXPECT_NEAR(trace.px_per_frame, size * e.px_per_s / e.fps, 0.02 * size * e.px_per_s / e.fps)
      << what;
  std::printf("%s: confidence %.3f, %.3f px a frame, R waves within %.2f frames\n", what.c_str(),
              trace.confidence, trace.px_per_frame, worst);
}

void expectFound(const DrawnEcg& e, const std::string& what) {
  const auto trace = readEcg(videoOf(ecgFrames(e), e.fps), ecgPicture(1).sector);
  ASSERT_TRUE(trace.has_value()) << what;
  expectWaves(*trace, e, what, 1);
}

constexpr EcgKind kKinds[] = {EcgKind::sweeping, EcgKind::scrolling, EcgKind::marked};

TEST(CompareEcg, RWavesOfEveryKindAreFoundWithinAFrame) {
  for (const EcgKind kind : kKinds)
    for (const double bpm : {55.0, 95.0})
      expectFound({.kind = kind, .r_s = evenBeats(bpm, 0.31)},
                  fmt::format("{}, {:.0f} bpm", nameOf(kind), bpm));
}

TEST(CompareEcg, ColourNoiseAndCompressionDoNotMatter) {
  const std::pair<const char*, cv::Scalar> colours[] = {
      {"green", {0, 255, 0}}, {"white", {255, 255, 255}}, {"yellow", {0, 220, 240}}};
  for (const EcgKind kind : kKinds)
    for (const auto& [name, colour] : colours) {
      const bool own = colour == colours[static_cast<std::size_t>(kind)].second;
      if (!own && !allCases()) continue;  // a colour for each kind
      expectFound({.kind = kind, .colour = colour, .r_s = evenBeats(70, 0.4), .noise = 6},
                  fmt::format("{}, {}, noise", nameOf(kind), name));
      expectFound({.kind = kind, .colour = colour, .r_s = evenBeats(70, 0.4), .jpeg_quality = 60},
                  fmt::format("{}, {}, JPEG", nameOf(kind), name));
    }
}

TEST(CompareEcg, AnEarlyBeatIsFoundWhereItIs) {
  std::vector<double> beats = evenBeats(75, 0.3);
  for (double& r : beats)
    if (std::abs(r - 1.1) < 1e-9) r -= 0.28;
  for (const EcgKind kind : kKinds)
    expectFound({.kind = kind, .frames = 80, .r_s = beats}, fmt::format("{}, early", nameOf(kind)));
}

TEST(CompareEcg, PacesAndHeadsOfAllKinds) {
  for (const double px_per_s : {40.0, 150.0, 240.0})
    for (const EcgKind kind : kKinds) {
      if (kind == EcgKind::marked && px_per_s > 100) continue;  // wider than the picture
      expectFound({.kind = kind, .px_per_s = px_per_s, .frames = 90, .r_s = evenBeats(66, 0.2)},
                  fmt::format("{}, {:.0f} px/s", nameOf(kind), px_per_s));
    }
  for (const int gap : {4, 30})
    expectFound({.r_s = evenBeats(66, 0.2), .gap_px = gap}, fmt::format("gap of {} px", gap));
  expectFound({.r_s = evenBeats(66, 0.2), .dot = true}, "a dot at the head");
  expectFound({.fps = 60, .frames = 130, .r_s = evenBeats(80, 0.1)}, "60 frames a second");
}

// A beat of a loop shows one R wave or two; what the trace has from before helps where it is shown.
TEST(CompareEcg, LoopsOfOneBeatAreEnough) {
  for (const EcgKind kind : kKinds)
    for (const double first_s : {0.1, 0.4, 0.6})
      expectFound({.kind = kind, .frames = 27, .r_s = evenBeats(66, first_s), .head_s = 0.5},
                  fmt::format("{}, one beat, R at {:.1f} s", nameOf(kind), first_s));
}

// The same in a picture of twice the size, whose lines are two pixels thick and smooth.
TEST(CompareEcg, LargerPicturesAreReadAlike) {
  for (const EcgKind kind : kKinds) {
    const DrawnEcg e{.kind = kind, .r_s = evenBeats(72, 0.35), .jpeg_quality = 80};
    std::vector<cv::Mat> frames = ecgFrames(e);
    for (cv::Mat& frame : frames) cv::resize(frame, frame, {}, 2, 2, cv::INTER_LINEAR);
    const Sector& s = ecgPicture(1).sector;
    const auto trace = readEcg(videoOf(frames, e.fps), {2 * s.apex_x, 2 * s.apex_y, s.first_rad,
                                                        s.last_rad, 2 * s.r_min, 2 * s.r_max});
    ASSERT_TRUE(trace.has_value()) << nameOf(kind);
    expectWaves(*trace, e, std::string(nameOf(kind)) + ", twice as large", 2);
  }
}

// What stands or moves beside a sector and is no ECG.
TEST(CompareEcg, WhatIsNoTraceIsNone) {
  const auto none = [](const char* what, const DrawMore& more, double noise = 4) {
    DrawnEcg e;
    e.drawn = false;
    e.noise = noise;
    const auto best = readEcg(videoOf(ecgFrames(e, more), e.fps), ecgPicture(1).sector, 0);
    std::printf("%s: confidence %.3f\n", what, best ? best->confidence : 0.0);
    EXPECT_LT(best ? best->confidence : 0, kEcgConfident) << what << ": " << best->kind;
  };
  const cv::Scalar white{230, 230, 230};
  none("nothing", {});
  none("a colour bar", [](cv::Mat& m, int) {
    for (int x = 0; x < 300; ++x)
      cv::line(m, {50 + x, 285}, {50 + x, 300}, {double(255 - x * 255 / 300), 40, x * 255.0 / 300},
               1);
    for (int y = 0; y < 120; ++y)
      cv::line(m, {8, 60 + y}, {18, 60 + y}, cv::Scalar::all(255 - 2 * y), 1);
  });
  const auto scale = [&](cv::Mat& m, int) {
    cv::line(m, {30, 300}, {370, 300}, white, 1);
    for (int x = 30; x <= 370; x += 34) cv::line(m, {x, 300}, {x, 285}, white, 1);
  };
  none("a scale with ticks", scale);
  none("a scale with ticks and a marker", [&](cv::Mat& m, int f) {
    scale(m, f);
    cv::line(m, {40 + 4 * f, 275}, {40 + 4 * f, 310}, white, 1);
  });
  none("a moving text", [&](cv::Mat& m, int f) {
    cv::putText(m, "Adult Echo  S5-1  20 Hz", {350 - 5 * f, 300}, cv::FONT_HERSHEY_SIMPLEX, 0.6,
                white, 1, cv::LINE_AA);
  });
  none("a clock", [&](cv::Mat& m, int f) {
    cv::putText(m, fmt::format("00:00:{:05.2f}  72 bpm", f / 30.0), {60, 300},
                cv::FONT_HERSHEY_SIMPLEX, 0.7, white, 1, cv::LINE_AA);
  });
  none("a bar that fills", [&](cv::Mat& m, int f) {
    cv::line(m, {30, 300}, {30 + 5 * f, 300}, white, 2);
  });
  none("breath", [&](cv::Mat& m, int f) {
    for (int x = 20; x < 380; ++x)
      cv::line(m, {x, int(295 - 15 * std::sin(0.05 * (x + 3 * f)))},
               {x + 1, int(295 - 15 * std::sin(0.05 * (x + 1 + 3 * f)))}, white, 1);
  });
  none("a trace that stands still", [](cv::Mat& m, int) {
    drawEcg(m, {.kind = EcgKind::scrolling, .r_s = evenBeats(70, 0.4)}, 0);
  });
}

// Sharp and tall ones alone, whatever the T waves; either way up.
TEST(CompareEcg, RWavesAreTheSharpOnes) {
  const std::vector<double> beats{0.5, 1.3, 2.1, 2.9};
  for (const double sign : {1.0, -1.0}) {
    std::vector<double> heights;
    for (int i = 0; i < 340; ++i) heights.push_back(sign * 40 * leadAt(beats, i / 100.0));
    const RWaves waves = findRWaves(heights, 1);
    ASSERT_EQ(waves.at.size(), beats.size());
    for (std::size_t i = 0; i < beats.size(); ++i) EXPECT_NEAR(waves.at[i], 100 * beats[i], 0.6);
    EXPECT_GT(waves.confidence, 0.6);
  }
  EXPECT_TRUE(findRWaves(std::vector<double>(100, 0.0), 1).at.empty());
  // Two or one alone are told from T and P waves too.
  for (const int samples : {170, 90}) {
    std::vector<double> heights;
    for (int i = 0; i < samples; ++i) heights.push_back(40 * leadAt(beats, i / 100.0));
    const RWaves waves = findRWaves(heights, 1);
    ASSERT_EQ(waves.at.size(), samples == 170 ? 2u : 1u);
    EXPECT_NEAR(waves.at[0], 50, 0.6);
    EXPECT_GT(waves.confidence, 0.6);
  }
}

}  // namespace
}  // namespace echocine::echo
