// The program as a user meets it: exit codes, messages, ranges, resuming, stopping.

#include <gtest/gtest.h>

#include <algorithm>

#include "support/loop_scene.h"
#include "support/paths.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

// One line on standard error that says all of `parts`.
void expectError(const Outcome& outcome, int code, const std::vector<std::string>& parts) {
  EXPECT_EQ(outcome.code, code) << outcome.err;
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_TRUE(outcome.err.starts_with("echocine: ")) << outcome.err;
  for (const std::string& part : parts)
    EXPECT_NE(outcome.err.find(part), std::string::npos) << part << " in " << outcome.err;
}

class CommandLine : public ::testing::Test {
 protected:
  fs::path scene() { return writeBall(folder, ballScene(5)); }
  Outcome renderAgain(const std::string& more = "") {
    return renderScene(folder / "scene.toml", folder / "out", more);
  }
  // Nothing was written when the input could not be used.
  void expectUnusable(const std::vector<std::string>& parts, const std::string& more = "") {
    expectError(renderAgain(more), 2, parts);
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
  TempFolder folder;
};

TEST_F(CommandLine, HelpNamesCommandsAndUnits) {
  const Outcome top = runShell("%B --help"), render = runShell("%B render --help");
  EXPECT_EQ(top.code, 0);
  EXPECT_NE(top.out.find("render"), std::string::npos);
  EXPECT_EQ(render.code, 0);
  for (const char* word : {"--threads", "--quiet", "--frames", "--resume", "unit"})
    EXPECT_NE(render.out.find(word), std::string::npos) << word;
  EXPECT_NE(runShell("%B --version").out.find(support::kVersion), std::string::npos);
}

// 2 and not 1: scripts try a failed job again, but not unusable arguments.
TEST_F(CommandLine, UnusableArgumentsAreCodeTwo) {
  for (const char* line :
       {"%B", "%B rendr x", "%B render", "%B render a.toml", "%B render a.toml -o b --threads -1",
        "%B render a.toml -o b --threads two", "%B render a.toml -o b --fast"})
    expectError(runShell(line), 2, {"--help"});
}

TEST_F(CommandLine, ARunWritesItsFilesAndNothingOnStandardErrorWhenQuiet) {
  scene();
  const Outcome outcome = renderAgain();
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.err + outcome.out, "");
  for (const char* name : {"intensity/frame_0000.exr", "intensity/frame_0004.exr", "cine.avi",
                           "report.html", "manifest.json"})
    EXPECT_GT(fs::file_size(folder / "out" / name), 100u) << name;
  EXPECT_FALSE(fs::exists(folder / "out/intensity/frame_0005.exr"));
}

TEST_F(CommandLine, ASceneIsFoundFromItsOwnFolder) {
  scene();
  const Outcome outcome =
      runShell("cd '" + folder.path().string() + "' && %B render scene.toml -o out --quiet");
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

// One line, with what is accepted.
TEST_F(CommandLine, AMissingSceneIsNamed) {
  expectUnusable({"scene.toml", "No such file"});
}

TEST_F(CommandLine, AnUnknownKeyIsNamedWithItsPlace) {
  SceneText text = ballScene(5);
  text.setProbe("framerate", "5");
  writeBall(folder, text);
  expectUnusable(
      {"scene.toml:" + std::to_string(lineOf(text.text(), "framerate")) + ": probe.framerate: "});
}

TEST_F(CommandLine, AVertexThatIsNotANumberIsNamed) {
  scene();
  for (const char* bad : {"nan", "inf", "1e999", "1e39"}) {
    std::string obj = bytesOf(folder / "wall_3.obj");
    obj.replace(obj.find(' ') + 1, obj.find(' ', 2) - 2, bad);
    folder.write("wall_3.obj", obj);
    expectUnusable({"scene.toml:", "keyframes: ", "wall_3.obj"});
  }
}

TEST_F(CommandLine, KeyframesWithDifferentFacesAreRefused) {
  scene();
  writeObj(icosphere(1, 3.5).moved({0.3, 0.2, 6}), folder / "wall_5.obj");
  expectUnusable({"scene.toml:", "wall_5.obj"});
}

TEST_F(CommandLine, AnEmptyMeshIsRefused) {
  scene();
  folder.write("wall_2.obj", "# nothing\n");
  expectUnusable({"scene.toml:", "wall_2.obj"});
}

TEST_F(CommandLine, AnInsideOutMeshIsRefused) {
  scene();
  for (int i = 0; i < 8; ++i)
    writeObj(icosphere(2, 3.5).moved({0.3, 0.2, 6}).insideOut(),
             folder / ("wall_" + std::to_string(i) + ".obj"));
  expectUnusable({"scene.toml:", "wall_0.obj", "inward"});
}

TEST_F(CommandLine, AnOpenMeshThatIsNoMembraneIsRefused) {
  scene();
  Mesh open = icosphere(2, 3.5);
  open.triangles.pop_back();
  for (int i = 0; i < 8; ++i) writeObj(open, folder / ("wall_" + std::to_string(i) + ".obj"));
  expectUnusable({"scene.toml:", "wall_0.obj"});
}

TEST_F(CommandLine, AFolderThatCannotBeMadeIsAFailedJob) {
  scene();
  folder.write("file", "in the way");
  expectError(renderScene(folder / "scene.toml", folder / "file/out"), 1,
              {(folder / "file").string()});
  EXPECT_EQ(bytesOf(folder / "file"), "in the way");
}

TEST_F(CommandLine, AFullDiskIsAFailedJobThatLeavesNoHalfFiles) {
  scene();
  const Outcome outcome = runShell("ulimit -f 4; %B render '" + (folder / "scene.toml").string() +
                                   "' -o '" + (folder / "out").string() + "' --quiet");
  expectError(outcome, 1, {"cannot be written"});
  for (const auto& entry : fs::recursive_directory_iterator(folder / "out")) {
    EXPECT_NE(entry.path().extension(), ".part") << entry.path();
    EXPECT_NE(entry.path().filename(), "manifest.json");
  }
}

TEST_F(CommandLine, RangesThatAreNotInTheLoopAreRefused) {
  scene();
  for (const char* range :
       {"5:6", "3:3", "4:2", "0:6", "-1:2", "x:y", "3", "1:2:3", "1:2x", "99999999999:"})
    expectUnusable({"--frames"}, std::string("--frames=") + range);
}

TEST_F(CommandLine, IntensitiesBeyondFloatsAreAFailedJobAndNoCrash) {
  for (const std::string exr : {"true", "false"}) {
    SceneText text = ballScene(2);
    text.structures.insert(text.structures.find("keyframes"), "reflection_gain = 1e300\n");
    text.output["exr"] = exr;
    writeBall(folder, text);
    const Outcome outcome = renderAgain();
    EXPECT_TRUE(outcome.code == 1 || outcome.code == 2) << outcome.code << ' ' << outcome.err;
  }
}

TEST_F(CommandLine, GainsBeyondFloatsAreRefusedAndNoCrash) {
  SceneText text = ballScene(2);
  text.signal = {{"tgc", "\"table\""}, {"tgc_table_mm_db", "[[0, 0], [50, 1e6]]"}};
  writeBall(folder, text);
  const Outcome outcome = renderAgain();
  EXPECT_TRUE(outcome.code == 1 || outcome.code == 2) << outcome.code << ' ' << outcome.err;
}

}  // namespace
}  // namespace echocine
