// Parts of a loop, runs that go on where another ended, and runs that are stopped.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "support/cine_frames.h"
#include "support/loop_scene.h"
#include "support/run_files.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

std::set<std::string> namesIn(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

class PartsOfALoop : public ::testing::Test {
 protected:
  PartsOfALoop() { writeBall(folder, ballScene(6)); }
  Outcome render(const std::string& more = "") { return renderScene(scene, out, more); }
  TempFolder folder;
  const fs::path scene = folder / "scene.toml", out = folder / "out";
};

TEST_F(PartsOfALoop, OnlyTheFramesAskedForAreWrittenAndTheyAreThoseOfTheWholeLoop) {
  ASSERT_EQ(render().code, 0);
  const fs::path part = folder / "part";
  for (const auto& [range, names] :
       std::map<std::string, std::set<std::string>>{{"2:4", {"frame_0002.exr", "frame_0003.exr"}},
                                                    {":1", {"frame_0000.exr"}},
                                                    {"5:", {"frame_0005.exr"}}}) {
    fs::remove_all(part);
    ASSERT_EQ(renderScene(scene, part, "--frames=" + range).code, 0);
    EXPECT_EQ(namesIn(part / "intensity"), names) << range;
    EXPECT_EQ(cineFrames(part / "cine.avi"), static_cast<int>(names.size()));
    for (const std::string& name : names)
      EXPECT_EQ(bytesOf(part / "intensity" / name), bytesOf(out / "intensity" / name)) << name;
  }
}

TEST_F(PartsOfALoop, AShorterRunLeavesNoFrameOfALongerOne) {
  ASSERT_EQ(render().code, 0);
  ASSERT_EQ(render("--frames=0:2").code, 0);
  EXPECT_EQ(namesIn(out / "intensity"),
            (std::set<std::string>{"frame_0000.exr", "frame_0001.exr"}));
}

// The bytes of an undisturbed run, whatever was there before.
TEST_F(PartsOfALoop, ResumingMendsWhatIsMissingTruncatedOrGarbageToTheSameBytes) {
  ASSERT_EQ(render().code, 0);
  const auto whole = lastingFiles(out);
  fs::remove(out / "intensity/frame_0001.exr");
  fs::remove(out / "intensity/frame_0004.exr");
  fs::remove(out / "cine.avi");
  fs::remove(out / "manifest.json");
  fs::resize_file(out / "intensity/frame_0002.exr", 1000);
  std::ofstream(out / "intensity/frame_0003.exr") << "not an EXR";
  const fs::file_time_type kept = fs::last_write_time(out / "intensity/frame_0000.exr");
  ASSERT_EQ(render("--resume").code, 0);
  EXPECT_EQ(lastingFiles(out), whole);
  EXPECT_EQ(fs::last_write_time(out / "intensity/frame_0000.exr"), kept);
  EXPECT_TRUE(fs::exists(out / "manifest.json"));
}

// Half a loop of one scene and half of another looks whole and is wrong.
TEST_F(PartsOfALoop, ResumingAChangedSceneIsRefusedAndHarmsNothing) {
  ASSERT_EQ(render().code, 0);
  const auto before = lastingFiles(out / "intensity");
  SceneText text = ballScene(6);
  text.setProbe("frequency_mhz", "2.6");
  folder.write("scene.toml", text.text());
  const Outcome outcome = render("--resume");
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find(".exr: belongs to another scene"), std::string::npos) << outcome.err;
  EXPECT_EQ(lastingFiles(out / "intensity"), before);
  EXPECT_TRUE(fs::exists(out / "manifest.json"));
  EXPECT_TRUE(fs::exists(out / "cine.avi"));
}

TEST_F(PartsOfALoop, ResumingWithOtherMeshesIsRefused) {
  ASSERT_EQ(render().code, 0);
  writeObj(icosphere(2, 3.4).moved({0.3, 0.2, 6}), folder / "wall_2.obj");
  EXPECT_EQ(render("--resume").code, 2);
}

TEST_F(PartsOfALoop, ResumingIntoAnEmptyFolderIsAnOrdinaryRun) {
  ASSERT_EQ(render().code, 0);
  const auto whole = lastingFiles(out);
  fs::remove_all(out);
  ASSERT_EQ(render("--resume").code, 0);
  EXPECT_EQ(lastingFiles(out), whole);
}

// A loop of hours, interrupted once its fifth frame is there.
TEST_F(PartsOfALoop, AnInterruptedRunLeavesAPlayableCineAndNoManifest) {
  for (const char* signal : {"INT", "TERM"}) {
    SceneText text = ballScene(1000);
    text.acquisition["beats"] = "900";
    text.signal["reference_intensity"] = "1e-7";  // no measuring pass: frames come at once
    folder.write("scene.toml", text.text());
    fs::remove_all(out);
    const Outcome outcome = runShell(
        "%B render '" + scene.string() + "' -o '" + out.string() +
        "' --quiet & pid=$!; while [ ! -e '" + (out / "intensity/frame_0005.exr").string() +
        "' ]; do sleep 0.02; done; kill -" + signal + " $pid; wait $pid");
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_NE(outcome.err.find("stopped"), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(out / "manifest.json"));
    const auto frames = static_cast<int>(namesIn(out / "intensity").size());
    EXPECT_GE(frames, 6);
    EXPECT_EQ(cineFrames(out / "cine.avi"), frames);
    EXPECT_FALSE(fs::exists(out / "cine.avi.part"));
  }
}

}  // namespace
}  // namespace echocine
