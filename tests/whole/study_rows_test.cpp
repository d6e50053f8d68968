// Rows of a study: their errors depend on no seed, and they are kept one by one.

#include "scene/scene_reader.h"
#include "study/study.h"
#include "support/studied_ball.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

class StudyRows : public StudiedBall {};
class StudySeeds : public StudiedBall {};

// A law of the mean over seeds: no error depends on the numbers that were drawn, so finer presets
// err less in a picture full of speckle and noise too.
TEST_F(StudySeeds, ErrorsDependOnNoSeedInALookWithSpeckleAndNoise) {
  Json errors[2];
  for (const int seed : {1, 2}) {
    SceneText text = studiedBall();
    text.signal["look"] = "\"scanner\"";
    text.signal["reference_intensity"] = "1e-4";
    const std::string drawn = "seed = " + std::to_string(seed) + "\n";
    text.extra = "[speckle]\n" + drawn + "[artefacts]\nnoise_" + drawn + "clutter_" + drawn;
    writeBall(folder, text);
    const std::string out = "seed" + std::to_string(seed);
    const Outcome outcome = study("--knobs samples", out);
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json json = this->json(out);
    EXPECT_LT(rmsOf(json, "fine"), 0.8 * rmsOf(json, "standard"));
    EXPECT_LT(rmsOf(json, "standard"), 0.8 * rmsOf(json, "draft"));
    for (const Json& row : json["rows"]) errors[seed - 1].push_back(row["errors"]);
    EXPECT_GT(json["rows"][0]["timing"]["stages_ms"]["speckle"].get<double>(), 0);
  }
  EXPECT_EQ(errors[0].dump(), errors[1].dump());
}

// Between keyframes this uneven each smooth interpolation overshoots and inverts the cavity.
TEST_F(StudyRows, ASettingThatCannotBeRenderedIsARowWithTheReason) {
  SceneText text = studiedBall();
  text.acquisition["frame_rate_hz"] = "20";
  text.motion["keyframe_phases"] = "[0, 0.03, 0.25, 0.4, 0.5, 0.6, 0.7, 0.85]";
  text.motion["interpolation"] = "\"linear\"";
  writeBall(folder, text);
  const double radii_cm[] = {3.2, 0.6, 0.6, 1, 2, 2.5, 3, 3.2};
  for (int i = 0; i < 8; ++i)
    writeObj(icosphere(2, radii_cm[i]).moved({0.3, 0.2, 6}),
             folder / ("cavity_" + std::to_string(i) + ".obj"));
  const Outcome outcome = study("--knobs interpolation");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("refused: interpolation spline, from draft: "), std::string::npos)
      << outcome.out;
  const Json json = this->json();
  EXPECT_EQ(json["refused"].size(), 6u) << json["refused"];  // three of them, in two sweeps
  for (const Json& row : json["refused"])
    EXPECT_NE(row["reason"].get<std::string>().find("inverted"), std::string::npos) << row;
  EXPECT_GT(rowOf(json, "from draft", "interpolation", "linear")["errors"]["rms_db"], 0);
  const std::string csv = bytesOf(folder / "out/study.csv");
  EXPECT_NE(csv.find("\"from draft\",\"interpolation\",\"spline\",,"), std::string::npos) << csv;
}

// Stopped after so many settings, what is finished is what the result holds.
TEST(StudyStop, KeepsTheRowsThatAreFinished) {
  const TempFolder folder;
  const Scene scene = readScene(writeBall(folder, studiedBall()));
  StudyOptions options;
  options.folder = folder / "out";
  options.frames = 1;
  options.repeats = 2;
  options.knobs = {"lines"};
  Monitor monitor;
  std::size_t done = 0;
  monitor.tell = [&](const Progress& progress) { done = progress.done; };
  monitor.keep_going = [&] { return done < 3; };
  std::size_t handed_over = 0;  // each row as soon as it is measured
  const StudyResult result = runStudy(scene, options, monitor, [&](const StudyResult& so_far) {
    EXPECT_EQ(so_far.rows.size(), ++handed_over);
  });
  EXPECT_EQ(handed_over, 3u);
  EXPECT_FALSE(result.complete);
  EXPECT_EQ(done, 3u);
  ASSERT_FALSE(result.rows.empty());
  for (const StudyRow& row : result.rows)
    EXPECT_FALSE(result.points[row.point].times.empty()) << row.knob << row.value;
  EXPECT_TRUE(fs::is_empty(folder / "out"));
}

TEST_F(StudyRows, CtrlCWritesTheFinishedRowsAndIsAFailedJob) {
  // The first round's files are there, then the signal: a background job of a shell ignores
  // Ctrl-C's own, and SIGTERM goes the same way.
  const std::string out = (folder / "out").string();
  const Outcome outcome = runShell(
      "%B study '" + (folder / "scene.toml").string() + "' -o '" + out +
      "' --frames 2 --repeats 1000 --knobs normals --quiet & job=$!; while [ ! -e '" + out +
      "/study.html' ] && kill -0 $job; do sleep 0.02; done; kill -TERM $job; wait $job");
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("stopped"), std::string::npos) << outcome.err;
  EXPECT_FALSE(json()["machine"]["complete"].get<bool>());
}

}  // namespace
}  // namespace echocine
