// echocine study: its files, its refusals, and what must be the same in every run.

#include <gtest/gtest.h>

#include "support/studied_ball.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

class StudyCommandTest : public StudiedBall {};

TEST_F(StudyCommandTest, WritesItsFilesAndATableAndLeavesNothingElse) {
  const Outcome outcome = study("--knobs lines,normals");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("RMS dB"), std::string::npos);
  EXPECT_NE(outcome.out.find("lines, from reference"), std::string::npos);
  for (const char* name : {"study.json", "study.csv", "study.html"})
    EXPECT_TRUE(fs::exists(folder / "out" / name));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out"), {}), 3);
}

TEST_F(StudyCommandTest, EveryKnobIsSweptFromDraftAndFromReference) {
  ASSERT_EQ(study().code, 0);
  const Json json = this->json();
  // What the tolerance of refraction decides is a fact of its knob.
  EXPECT_NE(json["knobs"].dump().find("echoes move by up to"), std::string::npos);
  for (const char* knob :
       {"lines", "samples", "subdivision", "normals", "keyframes", "interpolation", "refraction",
        "echoes", "snell_angles", "reflection_cap", "thin_layers", "tgc", "exr_pixel",
        "exr_compression"}) {
    std::size_t values = 0;
    for (const Json& k : json["knobs"])
      if (k["name"] == knob) values = k["values"].size();
    EXPECT_GE(values, 2u) << knob;
    for (const char* sweep : {"from draft", "from reference"}) {
      std::size_t rows = 0;
      for (const Json& row : json["rows"]) rows += row["sweep"] == sweep && row["knob"] == knob;
      EXPECT_EQ(rows, values) << knob << ' ' << sweep;
    }
  }
}

// What is asserted of the presets: the reference errs by nothing, each one errs less than the one
// before it, and so does each finer value of lines and of samples from the reference.
TEST_F(StudyCommandTest, FinerPresetsErrLess) {
  ASSERT_EQ(study("--knobs lines,samples,subdivision").code, 0);
  const Json json = this->json();
  EXPECT_EQ(rmsOf(json, "reference"), 0);
  EXPECT_LT(rmsOf(json, "fine"), rmsOf(json, "standard"));
  EXPECT_LT(rmsOf(json, "standard"), rmsOf(json, "draft"));
  EXPECT_GT(rmsOf(json, "fine"), 0);
  for (const Json& knob : json["knobs"]) {
    if (knob["name"] != "lines" && knob["name"] != "samples") continue;
    double before = 1e9;
    for (const Json& value : knob["values"]) {
      const Json& row = rowOf(json, "from reference", knob["name"], value);
      const double rms = row["errors"]["rms_db"].get<double>();
      EXPECT_LT(rms, before) << knob["name"] << ' ' << value;
      before = rms;
    }
  }
}

// What files keep, as the picture of what is read back: every bit without loss; with it, a relative
// error of 2^-11 (half) or 2^-16 (pxr24) of an intensity, 4.34 times that in dB.
TEST_F(StudyCommandTest, StoredIntensitiesErrByWhatTheirPixelsLose) {
  ASSERT_EQ(study("--knobs exr_pixel,exr_compression").code, 0);
  const Json json = this->json();
  const auto stored = [&](const char* knob, const char* value) {
    return rowOf(json, "from reference", knob, value);
  };
  const auto rms = [](const Json& row) { return row["errors"]["rms_db"].get<double>(); };
  const auto bytes = [](const Json& row) { return row["exr_bytes_per_frame"].get<double>(); };
  const Json whole = stored("exr_compression", "none");
  for (const char* lossless : {"none", "rle", "zips", "zip", "piz"}) {
    const Json row = stored("exr_compression", lossless);
    EXPECT_EQ(rms(row), 0) << lossless;
    EXPECT_EQ(row["errors"]["ssim"], whole["errors"]["ssim"]) << lossless;
    EXPECT_GT(bytes(row), 0) << lossless;
    EXPECT_LE(bytes(row), bytes(whole)) << lossless;
  }
  const double half = rms(stored("exr_pixel", "half")),
               pxr24 = rms(stored("exr_compression", "pxr24"));
  EXPECT_GT(pxr24, 0);
  EXPECT_LT(pxr24, 4.35 * 0x1p-16);
  EXPECT_GT(half, pxr24);
  EXPECT_LT(half, 4.35 * 0x1p-11);
  EXPECT_LT(bytes(stored("exr_pixel", "half")), 0.55 * bytes(whole));
  EXPECT_LT(bytes(stored("exr_compression", "pxr24")), bytes(whole));
  EXPECT_EQ(whole["errors"]["interface_rms_mm"],
            stored("exr_pixel", "half")["errors"]["interface_rms_mm"]);
}

// Presets leave the storage alone, and a frame is as large as the one that is rendered.
TEST_F(StudyCommandTest, FilesAreThoseOfTheRenderedScene) {
  SceneText text = studiedBall();
  text.output["exr_pixel"] = "\"half\"";
  writeBall(folder, text);
  ASSERT_EQ(study("--knobs exr_pixel").code, 0);
  const Json json = this->json();
  for (const Json& knob : json["knobs"]) {
    if (!knob["name"].get<std::string>().starts_with("exr_")) continue;
    for (const Json& value : knob["presets"])
      EXPECT_EQ(value, knob["name"] == "exr_pixel" ? "half" : "none");
  }
  EXPECT_GT(rmsOf(json, "reference"), 0);  // stored halves, against the intensities themselves
  EXPECT_EQ(rowOf(json, "from reference", "exr_pixel", "float")["errors"]["rms_db"], 0);
  ASSERT_EQ(renderScene(folder / "scene.toml", folder / "loop", "--frames=:1").code, 0);
  EXPECT_EQ(rowOf(json, "preset", "preset", "scene")["exr_bytes_per_frame"],
            fs::file_size(folder / "loop/intensity/frame_0000.exr"));
}

TEST_F(StudyCommandTest, AllButTimesIsTheSameWhateverTheThreads) {
  ASSERT_EQ(study("--knobs refraction,exr_compression --threads 1", "one").code, 0);
  ASSERT_EQ(study("--knobs refraction,exr_compression --threads 2 --repeats 2", "two").code, 0);
  EXPECT_EQ(withoutTimes(json("one")).dump(), withoutTimes(json("two")).dump());
}

TEST_F(StudyCommandTest, EachRowHasItsErrorsTimesAndKeys) {
  ASSERT_EQ(study("--knobs samples").code, 0);
  const Json json = this->json();
  EXPECT_EQ(json["frames"].size(), 2u);
  EXPECT_TRUE(json["machine"]["complete"].get<bool>());
  bool front = false;
  for (const Json& row : json["rows"]) {
    const Json &e = row["errors"], &t = row["timing"];
    EXPECT_LE(e["rms_db"].get<double>(), e["worst_frame_rms_db"].get<double>() + 1e-12);
    EXPECT_LE(e["worst_frame_rms_db"], e["max_db"]);
    EXPECT_LE(e["ssim"].get<double>(), 1 + 1e-12);
    EXPECT_LE(e["interface_missed"].get<double>(), 1);
    EXPECT_GT(t["ms_per_frame"].get<double>(), 0);
    EXPECT_LE(t["first_quartile_ms"], t["third_quartile_ms"]);
    for (const char* stage :
         {"motion", "geometry", "trace", "signal", "scan_conversion", "exr", "avi"})
      EXPECT_GT(t["stages_ms"][stage].get<double>(), 0) << stage;
    front = front || t["pareto"].get<bool>();
  }
  EXPECT_TRUE(front);
  // Halves of samples stand half a sample off at most.
  EXPECT_LT(rowOf(json, "preset", "preset", "reference")["errors"]["interface_rms_mm"],
            rowOf(json, "preset", "preset", "draft")["errors"]["interface_rms_mm"]);
}

TEST_F(StudyCommandTest, TheCsvHasARowForEachRowAndAColumnForEachHead) {
  ASSERT_EQ(study("--knobs lines").code, 0);
  std::istringstream lines(bytesOf(folder / "out/study.csv"));
  std::string head, line;
  std::getline(lines, head);
  const auto commas = [](const std::string& text) {
    bool quoted = false;
    int count = 0;
    for (const char c : text) {
      if (c == '"') quoted = !quoted;
      count += c == ',' && !quoted;
    }
    EXPECT_FALSE(quoted) << text;
    return count;
  };
  std::size_t rows = 0;
  for (; std::getline(lines, line); ++rows) EXPECT_EQ(commas(line), commas(head)) << line;
  EXPECT_EQ(rows, json()["rows"].size() + json()["refused"].size());
}

TEST_F(StudyCommandTest, KnobsThatCannotApplyAreLeftOutWithTheReason) {
  SceneText text = studiedBall();
  text.motion.erase("subdivision");
  text.effects["refraction"] = "\"off\"";
  text.output["exr"] = "false";
  writeBall(folder, text);
  const Outcome outcome = study("--knobs lines");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* part :
       {"left out: subdivision: ", "left out: normals: ",
        "left out: refraction: effects.refraction", "left out: exr_pixel: output.exr = false",
        "left out: exr_compression: output.exr = false"})
    EXPECT_NE(outcome.out.find(part), std::string::npos) << part << " in " << outcome.out;
}

// Preparing every setting of a large scene takes longer than a short budget.
TEST_F(StudyCommandTest, ABudgetBoundsThePreparationToo) {
  writeBall(folder, studiedBall());
  const Outcome outcome = study("--budget-s 0.001");
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(json()["rows"].size(), 1u);
  EXPECT_NE(outcome.out.find("more rows: --budget-s 0.001 leaves no time"), std::string::npos)
      << outcome.out;
}

TEST_F(StudyCommandTest, UnusableArgumentsAreCodeTwoAndOneLine) {
  for (const char* more : {"--knobs colour", "--frames 0", "--repeats 0", "--budget-s -1",
                           "--threads -1", "--frames two"}) {
    const Outcome outcome = runShell("%B study '" + (folder / "scene.toml").string() + "' -o '" +
                                     (folder / "out").string() + "' " + more);
    EXPECT_EQ(outcome.code, 2) << more;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(folder / "out")) << more;
  }
  EXPECT_EQ(runShell("%B study nowhere.toml -o x").code, 2);
  const Outcome help = runShell("%B study --help");
  EXPECT_EQ(help.code, 0);
  for (const char* word : {"--budget-s", "SECONDS", "ms", "dB", "--knobs", "subdivision"})
    EXPECT_NE(help.out.find(word), std::string::npos) << word;
}

TEST_F(StudyCommandTest, AFolderThatCannotBeMadeIsAFailedJob) {
  folder.write("file", "");
  const Outcome outcome = study("", "file");
  EXPECT_EQ(outcome.code, 1);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
}

}  // namespace
}  // namespace echocine
