// The ECG of a video anchors its beat, and every result says by what beats start.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "compare/compare.h"
#include "core/parallel.h"
#include "fit/model_discrepancy.h"
#include "support/drawn_ecg.h"
#include "support/drawn_heart.h"
#include "support/loop_scene.h"
#include "support/run_program.h"

namespace echocine::echo {
namespace {

using namespace support;

// Beats of 25 frames at 30 a second, whose pictures start at the R wave.
constexpr double kBeatFrames = 25, kFps = 30;

void writeWithEcg(const std::filesystem::path& folder, double r_frame, EcgKind kind,
                  int frames = 60) {
  DrawnEcg e{.kind = kind,
             .fps = kFps,
             .frames = frames,
             .r_s = evenBeats(60 * kFps / kBeatFrames, r_frame / kFps),
             .jpeg_quality = 85};
  Drawing d = ecgPicture(frames);
  d.frames_per_beat = kBeatFrames;
  d.time_shift = -r_frame;
  std::vector<cv::Mat> pictures = coloured(drawnLoop(d), d.width, d.height);
  for (int f = 0; f < frames; ++f) drawEcg(pictures[static_cast<std::size_t>(f)], e, f);
  writePictures(folder, pictures, ".jpg");
}

class VideoWithEcg : public ::testing::Test {
 protected:
  std::string in(const char* name) const { return " '" + (folder / name).string() + "'"; }
  nlohmann::json summaryOf(const char* out) const {
    return nlohmann::json::parse(bytesOf(folder / out / "summary.json"));
  }
  Outcome compared(const char* out, const std::string& more = "") const {
    return runShell("%B compare" + in("synthetic") + in("real") + " -o" + in(out) +
                    " --fps 30 --synthetic-fps 30" + more);
  }
  TempFolder folder;
};

TEST_F(VideoWithEcg, ItsRWavesPairFramesAndAreTold) {
  writeWithEcg(folder / "synthetic", 4, EcgKind::scrolling);
  writeWithEcg(folder / "real", 13.5, EcgKind::sweeping);
  const Outcome o = compared("out");
  ASSERT_EQ(o.code, 0) << o.err;
  EXPECT_NE(o.out.find("  beat: ECG in the picture, sweeping, "), std::string::npos) << o.out;
  const nlohmann::json summary = summaryOf("out");
  EXPECT_EQ(summary.at("time").at("method"), "R waves of the ECG in the picture");
  EXPECT_NEAR(
      std::remainder(summary.at("time").at("shift_frames").get<double>() - (4 - 13.5), kBeatFrames),
      0, 1);
  const nlohmann::json& beat = summary.at("real").at("beat");
  EXPECT_EQ(beat.at("anchor"), "ECG in the picture");
  EXPECT_EQ(beat.at("source"), "ECG in the picture");
  EXPECT_NEAR(beat.at("frames").get<double>(), kBeatFrames, 0.5);
  EXPECT_EQ(beat.at("ecg").at("kind"), "sweeping");
  EXPECT_NEAR(beat.at("ecg").at("px_per_s").get<double>(), 90, 2);
  EXPECT_EQ(summary.at("synthetic").at("beat").at("ecg").at("kind"), "scrolling");
  EXPECT_NE(bytesOf(folder / "out/compare.html").find("beats start by"), std::string::npos);

  ASSERT_EQ(compared("without", " --no-ecg").code, 0);
  EXPECT_EQ(summaryOf("without").at("real").at("beat").at("anchor"), "the picture itself");
  EXPECT_TRUE(summaryOf("without").at("real").at("beat").at("ecg").is_null());
  const Outcome given =
      compared("given", " --real-r-waves 0.45,1.28 --synthetic-r-waves 0.13,0.97");
  ASSERT_EQ(given.code, 0) << given.err;
  EXPECT_NE(given.out.find("  beat: given\n"), std::string::npos) << given.out;
  EXPECT_EQ(summaryOf("given").at("time").at("method"), "R waves");
}

// The trace that this program draws itself, with its cursor, in a video that nobody tells about.
TEST_F(VideoWithEcg, TheProgramsOwnTraceIsRead) {
  SceneText text = ballScene(30);
  text.acquisition["beats"] = "3";
  text.output["width"] = "640";
  text.output["height"] = "480";
  text.output["ecg"] = "true";
  ASSERT_EQ(renderScene(writeBall(folder, text), folder / "loop").code, 0);
  std::filesystem::copy(folder / "loop/cine.avi", folder / "own.avi");
  const double beat = readLoop(folder / "loop", {}, false).frames_per_beat;
  const EchoLoop loop = readLoop(folder / "own.avi", {}, true);
  ASSERT_TRUE(loop.ecg.has_value());
  EXPECT_EQ(loop.ecg->kind, "still, with a marker");
  EXPECT_NEAR(loop.ecg->beat_frames, beat, 0.5);
  ASSERT_GE(loop.rWaveFrames().size(), 2u);
  for (const double r : loop.rWaveFrames()) EXPECT_NEAR(std::remainder(r, beat), 0, 1) << r;
}

// The sector, the scale and what is compared are as without a trace beneath.
TEST_F(VideoWithEcg, TheTraceChangesNothingElse) {
  writeWithEcg(folder / "real", 13.5, EcgKind::sweeping, 40);
  const EchoLoop loop = readLoop(folder / "real", {}, true);
  const Sector right = ecgPicture(1).sector;
  EXPECT_NEAR(loop.sector().apex_x, right.apex_x, 2);
  EXPECT_NEAR(loop.sector().r_max, right.r_max, 3);
  ASSERT_TRUE(loop.ecg.has_value());
  // What is burnt in goes, as ever.
  for (const PixelPlane& frame : loop.video.frames)
    for (int x = kEcgLeft; x < kEcgRight; ++x)
      ASSERT_EQ(frame[static_cast<std::size_t>(310 * kEcgWidth + x)], 0);
}

// A model's beat starts at the R wave of a usual beat, with the trace's confidence.
TEST(EcgOfALoop, AModelsBeatStartsAtItsRWave) {
  withThreads(2, [] {
    EchoLoop loop = draw(Phantom{}, {}, 20, 3, 0.35);  // end-diastole at frame 13
    loop.frames_per_beat = 0;
    loop.beat_anchor = "ECG in the picture";
    loop.ecg = EcgTrace{"sweeping", 0, 9, 0, 9, 3, {-7, 13, 33}, 20, 0.7};
    const ModelDiscrepancy d(loop, {}, Phantom{}.model());
    EXPECT_EQ(d.beat().start_source, "ECG in the picture");
    EXPECT_EQ(d.beat().length_source, "ECG in the picture");
    EXPECT_EQ(d.beat().span.end_diastole, 13);
    EXPECT_EQ(d.beat().span.frames, 20);
    EXPECT_EQ(d.beat().confidence, 0.7);
    SideOptions side;
    side.ed_frame = 2;
    EXPECT_EQ(ModelDiscrepancy(loop, side, Phantom{}.model()).beat().span.end_diastole, 2);
  });
}

// Of beats of 20, 12 and 28 frames, the usual one that is whole.
TEST(EcgOfALoop, AnEarlyBeatIsNotTheUsualOne) {
  const EcgTrace trace{"scrolling", 0, 9, 0, 9, 3, {-10, 2, 30, 50, 70}, 20, 0.7};
  const auto beat = usualBeat(trace, 60);
  ASSERT_TRUE(beat.has_value());
  EXPECT_EQ(beat->r_frame, 30);
  EXPECT_EQ(beat->frames, 20);
  EXPECT_EQ(rWavesWithin(trace, 60), (std::vector<double>{2, 30, 50}));
  EXPECT_FALSE(usualBeat(EcgTrace{"scrolling", 0, 9, 0, 9, 3, {5}, 0, 0.7}, 60).has_value());
}

// Neither of the two videos shows a trace: one has none around its sector, the other a bar of
// buttons and a scale.
TEST(EcgOfALoop, RealVideosWithoutATraceHaveNone) {
  const std::filesystem::path videos = std::filesystem::path(kSharedDir) / "real/videos";
  if (!std::filesystem::is_directory(videos)) GTEST_SKIP() << videos << " is absent";
  for (const char* name : {"a4c_echotracker_45f.mp4", "a4c_sonosite_30f.dcm"})
    EXPECT_EQ(readLoop(videos / name, {}, true).beat_anchor, "the picture itself") << name;
}

}  // namespace
}  // namespace echocine::echo
