// A render as one side of the comparison: its folder says what of a video has to be found.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/compare.h"
#include "core/parallel.h"
#include "support/cine_frames.h"
#include "support/echo_video.h"
#include "support/loop_scene.h"
#include "support/run_program.h"

namespace echocine::compare {

using namespace echo;
namespace {

using namespace support;

TEST(ComparedRender, ARenderAgainstItselfIsPerfectAndItsResultsAreWhole) {
  TempFolder folder;
  SceneText text = ballScene(8);
  const std::filesystem::path scene = writeBall(folder, text);
  ASSERT_EQ(renderScene(scene, folder / "loop").code, 0);
  const auto quoted = [&](const char* name) { return " '" + (folder / name).string() + "'"; };
  const Outcome o = runShell("%B compare" + quoted("loop") + quoted("loop") + " -o" +
                             quoted("out") + " --contours --scene" + quoted("scene.toml"));
  ASSERT_EQ(o.code, 0) << o.err;
  const nlohmann::json summary = nlohmann::json::parse(bytesOf(folder / "out/summary.json"));
  EXPECT_LT(summary.at("discrepancy").get<double>(), 1e-4);
  EXPECT_EQ(summary.at("before_calibration").at("rms").get<double>(), 0);
  EXPECT_EQ(summary.at("before_calibration").at("ncc").get<double>(), 1);
  EXPECT_TRUE(summary.at("before_calibration").at("psnr_db").is_null());
  EXPECT_EQ(summary.at("time").at("shift_frames").get<double>(), 0);
  EXPECT_TRUE(summary.at("bands_after_calibration").contains("cavity"));
  const auto& lines = summary.at("contours");
  EXPECT_EQ(std::count(lines.begin(), lines.end(), "cavity"), 1);  // whose lines are drawn
  EXPECT_EQ(cineFrames(folder / "out/side_by_side.avi"), 8);
  const std::string csv = bytesOf(folder / "out/frames.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 9);
  EXPECT_TRUE(std::filesystem::exists(folder / "out/sector_real.png"));
}

// Beats of different lengths keep their own phases: bands and contours follow the manifest.
TEST(ComparedRender, PhasesOfVariedBeatsAreThoseOfTheManifest) {
  TempFolder folder;
  SceneText text = ballScene(8);
  text.acquisition["beats"] = "4";
  text.acquisition["rr_variability"] = "0.2";
  ASSERT_EQ(renderScene(writeBall(folder, text), folder / "loop").code, 0);
  CompareOptions options;
  options.synthetic = options.real = folder / "loop";
  Comparison c;
  withThreads(2, [&] { c = compareLoops(options); });
  const std::vector<double>& phases = c.synthetic.phases;
  double worst = 0, worst_of_mean = 0;
  for (const FrameResult& f : c.frames) {
    if (!f.counted()) continue;
    const auto before = std::min(static_cast<std::size_t>(f.synthetic_place), phases.size() - 2);
    const double step = phases[before + 1] - phases[before],
                 phase = phases[before] + (f.synthetic_place - static_cast<double>(before)) *
                                              (step < 0 ? step + 1 : step),
                 of_mean = f.synthetic_place / c.synthetic_beat.frames;
    worst = std::max(worst, std::abs(std::remainder(f.synthetic_phase - phase, 1.0)));
    worst_of_mean = std::max(worst_of_mean, std::abs(std::remainder(of_mean - phase, 1.0)));
  }
  EXPECT_LT(worst, 1e-9);
  EXPECT_GT(worst_of_mean, 0.02);
}

// A ball lies anywhere about its axis, so where its scene fits is only a hint: in the terminal, in
// JSON and in the page's data. A scene is in mm, so a loop without a scale is refused.
TEST(FittedRender, AFitOfASceneSaysWhatAReaderMustKnow) {
  TempFolder folder;
  ASSERT_EQ(renderScene(writeBall(folder, ballScene(8)), folder / "loop").code, 0);
  const auto quoted = [&](const char* name) { return " '" + (folder / name).string() + "'"; };
  const std::string scene = " --scene" + quoted("scene.toml"), hint = "only a hint: its confidence";
  const Outcome o =
      runShell("%B compare" + quoted("loop") + quoted("loop") + " -o" + quoted("out") + scene);
  ASSERT_EQ(o.code, 0) << o.err;
  const auto fit = nlohmann::json::parse(bytesOf(folder / "out/summary.json")).at("scene_fit");
  EXPECT_LT(fit.at("confidence").get<double>(), 0.1);
  EXPECT_NE(o.out.find(hint), std::string::npos) << o.out;
  ASSERT_EQ(fit.at("caveats").size(), 1u) << fit.at("caveats");
  EXPECT_TRUE(fit.at("caveats")[0].get<std::string>().starts_with(hint));
  EXPECT_NE(bytesOf(folder / "out/compare.html").find(hint), std::string::npos);
  Drawing rings;
  rings.frames = 12;
  writeLossless(folder / "rings.avi", rings);
  const Outcome drawn =
      runShell("%B compare" + quoted("loop") + quoted("rings.avi") + " -o" + quoted("none") +
               scene + " --quiet --real-ed 0 --sector=160,5,-40,40,12,225");
  EXPECT_EQ(drawn.code, 2) << drawn.err;
  EXPECT_NE(drawn.err.find("no length scale; give --scale"), std::string::npos) << drawn.err;
}

// Where no tilt is requested nothing is written of one; where one is, it is told. A loop without
// its scene has no other plane.
TEST(FittedRender, ATiltIsToldWhereItIsAskedFor) {
  TempFolder folder;
  ASSERT_EQ(renderScene(writeBall(folder, ballScene(8)), folder / "loop").code, 0);
  const auto quoted = [&](const char* name) { return " '" + (folder / name).string() + "'"; };
  const auto compared = [&](const char* out, const std::string& more) {
    return runShell("%B compare" + quoted("loop") + quoted("loop") + " -o" + quoted(out) + more);
  };
  const std::string scene = " --scene" + quoted("scene.toml");
  ASSERT_EQ(compared("plain", scene).code, 0);
  ASSERT_EQ(compared("zero", scene + " --tilt 0").code, 0);
  const Outcome tilted = compared("tilted", scene + " --tilt 5");
  ASSERT_EQ(tilted.code, 0) << tilted.err;
  for (const char* file : {"summary.json", "compare.html", "frames.csv"})
    EXPECT_EQ(bytesOf(folder / "plain" / file), bytesOf(folder / "zero" / file)) << file;
  const auto fitOf = [&](const char* out) {
    return nlohmann::json::parse(bytesOf(folder / out / "summary.json")).at("scene_fit");
  };
  EXPECT_FALSE(fitOf("plain").contains("tilt"));
  const nlohmann::json tilt = fitOf("tilted").at("tilt");
  EXPECT_EQ(tilt.at("most_deg").get<double>(), 5);
  EXPECT_LE(std::abs(tilt.at("tilt_deg").get<double>()), 5);
  EXPECT_LE(tilt.at("discrepancy").get<double>(), tilt.at("discrepancy_untilted").get<double>());
  EXPECT_GT(tilt.at("planes").get<int>(), 25);
  EXPECT_NE(tilt.at("probe_toml").get<std::string>().find("lateral = "), std::string::npos);
  EXPECT_NE(tilted.out.find("  tilt: "), std::string::npos) << tilted.out;
  EXPECT_NE(bytesOf(folder / "tilted/compare.html").find("rotate_confidence"), std::string::npos);

  const Outcome alone = compared("alone", " --tilt 5");
  EXPECT_EQ(alone.code, 2);
  EXPECT_EQ(std::count(alone.err.begin(), alone.err.end(), '\n'), 1) << alone.err;
  EXPECT_NE(alone.err.find("--tilt: needs --scene"), std::string::npos) << alone.err;
  for (const char* bad : {"21", "-1", "much"}) {
    const Outcome o = compared("bad", scene + " --tilt=" + bad);
    EXPECT_EQ(o.code, 2) << bad;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    EXPECT_NE(o.err.find("tilt"), std::string::npos) << o.err;
  }
}

// Greys of a render come from its EXR where they are all there, else from its cine.
TEST(ComparedRender, GreysOfARenderAreThoseOfItsExrWhereItHasThem) {
  TempFolder folder;
  SceneText text = ballScene(6);
  text.output["channels"] = "[\"display.Y\"]";
  ASSERT_EQ(renderScene(writeBall(folder, text), folder / "loop").code, 0);
  CompareOptions options;
  options.synthetic = options.real = folder / "loop";
  const auto compared = [&] {
    Comparison c;
    withThreads(2, [&] { c = compareLoops(options); });
    return c;
  };
  const Comparison exact = compared();
  EXPECT_EQ(exact.synthetic.grey_source, "EXR display.Y");
  EXPECT_EQ(exact.discrepancy, 0);
  EXPECT_EQ(exact.mean_before.rms, 0);
  // The files of a part of a loop have the numbers of its frames.
  EXPECT_EQ(runShell("%B render '" + (folder / "scene.toml").string() + "' -o '" +
                     (folder / "part").string() + "' --frames 2:6 --quiet")
                .code,
            0);
  CompareOptions part = options;
  part.synthetic = folder / "part";
  withThreads(2, [&] { EXPECT_EQ(compareLoops(part).synthetic.grey_source, "EXR display.Y"); });
  std::filesystem::remove(folder / "loop/intensity/frame_0003.exr");
  const Comparison cine = compared();
  EXPECT_EQ(cine.synthetic.grey_source, "cine.avi");
  EXPECT_FALSE(cine.synthetic.video.notes.empty());
  EXPECT_EQ(cine.discrepancy, 0);
  // The same greys but for 8 bits, JPEG and the picture's pixels.
  const std::vector<float>&a = exact.synthetic_beams.frames[1], &b = cine.synthetic_beams.frames[1];
  ASSERT_EQ(a.size(), b.size());
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (exact.weights[i] > 0) sum += std::abs(a[i] - b[i]), ++n;
  EXPECT_LT(sum / n, 4);
  EXPECT_GT(sum, 0);
}

}  // namespace
}  // namespace echocine::compare
