// Parts of a loop, runs that go on where another ended, and runs that are stopped.

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "core/seal.h"
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

// What a disk or a copy does to a file whose size stays; the manifest of the earlier run is there.
TEST_F(PartsOfALoop, ResumingMendsAFlippedByteToTheSameBytesAndSaysSo) {
  for (const char* compression : {"none", "rle", "zips", "zip", "piz", "pxr24"}) {
    SceneText text = ballScene(6);
    text.output["exr_compression"] = std::string("\"") + compression + "\"";
    folder.write("scene.toml", text.text());
    fs::remove_all(out);
    ASSERT_EQ(render().code, 0);
    const auto whole = lastingFiles(out);
    const fs::path damaged = out / "intensity/frame_0002.exr";
    std::string bytes = bytesOf(damaged);
    bytes[bytes.size() - 40] = static_cast<char>(bytes[bytes.size() - 40] ^ 0x10);
    std::ofstream(damaged, std::ios::binary) << bytes;
    const Outcome outcome =
        runShell("%B render '" + scene.string() + "' -o '" + out.string() + "' --resume 2>&1");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("frame_0002.exr: damaged"), std::string::npos) << outcome.out;
    EXPECT_EQ(lastingFiles(out), whole) << compression;
  }
}

// A frame that is sound in itself, but another one than the manifest tells of.
TEST_F(PartsOfALoop, ResumingMakesFramesAgainThatTheManifestDoesNotKnow) {
  ASSERT_EQ(render().code, 0);
  const auto whole = lastingFiles(out);
  std::string manifest = bytesOf(out / "manifest.json");
  const std::string hash = [&] {
    const std::size_t at = manifest.find("\"intensity/frame_0001.exr\": \"");
    return manifest.substr(at + 29, 64);
  }();
  for (std::size_t at = 0; (at = manifest.find(hash)) != std::string::npos;)
    manifest.replace(at, 64, std::string(64, 'e'));
  manifest.erase(manifest.rfind(",\n \"manifest_sha256"));
  std::ofstream(out / "manifest.json") << sealed(manifest + "\n}");
  const Outcome outcome =
      runShell("%B render '" + scene.string() + "' -o '" + out.string() + "' --resume 2>&1");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("frame_0001.exr: not the file"), std::string::npos) << outcome.out;
  EXPECT_EQ(lastingFiles(out), whole);
}

TEST_F(PartsOfALoop, AFolderOfAnotherSceneIsReplacedOnlyWhenAsked) {
  ASSERT_EQ(render().code, 0);
  ASSERT_EQ(render().code, 0) << "the same scene again";
  const auto before = lastingFiles(out);
  SceneText text = ballScene(6);
  text.setProbe("frequency_mhz", "2.6");
  folder.write("scene.toml", text.text());
  const Outcome outcome = render();
  EXPECT_EQ(outcome.code, 2) << outcome.err;
  EXPECT_NE(outcome.err.find("--overwrite"), std::string::npos) << outcome.err;
  EXPECT_EQ(lastingFiles(out), before);
  EXPECT_TRUE(fs::exists(out / "manifest.json"));
  fs::remove_all(out / "intensity");
  EXPECT_EQ(render().code, 2) << "the manifest alone tells";
  EXPECT_EQ(render("--resume").code, 2) << "also on resuming";
  EXPECT_EQ(render("--overwrite").code, 0);
}

TEST_F(PartsOfALoop, AFreshRunRemovesNoNameThatItNeverWrites) {
  ASSERT_EQ(render().code, 0);
  const std::set<std::string> own{"frame_1.exr", "frame_00000.exr", "frame_+001.exr"};
  for (const std::string& name : own) std::ofstream(out / "intensity" / name) << "mine";
  ASSERT_EQ(render("--frames=0:1").code, 0);
  for (const std::string& name : own) EXPECT_TRUE(fs::exists(out / "intensity" / name)) << name;
  EXPECT_FALSE(fs::exists(out / "intensity/frame_0001.exr"));
}

// The reference of a long loop is of frames spread over it; parts show the grey of the whole.
TEST_F(PartsOfALoop, APartOfALongLoopIsThatOfTheWholeAndMeasuresFewFrames) {
  SceneText text = ballScene(200);
  text.output["report"] = "false";
  folder.write("scene.toml", text.text());
  ASSERT_EQ(render().code, 0);
  const fs::path part = folder / "part";
  const Outcome outcome = runShell("%B render '" + scene.string() + "' -o '" + part.string() +
                                   "' --frames=150:152 2>&1");
  ASSERT_EQ(outcome.code, 0);
  EXPECT_NE(outcome.out.find("/64 frames"), std::string::npos) << outcome.out;
  for (const char* name : {"frame_0150.exr", "frame_0151.exr"})
    EXPECT_EQ(bytesOf(part / "intensity" / name), bytesOf(out / "intensity" / name)) << name;
}

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
    // Of frames that are made at once a later one may be whole.
    EXPECT_LE(cineFrames(out / "cine.avi"), frames);
    EXPECT_GE(cineFrames(out / "cine.avi"), 1);
    for (const std::string& name : namesIn(out)) EXPECT_FALSE(name.ends_with(".part")) << name;
  }
}

}  // namespace
}  // namespace echocine
