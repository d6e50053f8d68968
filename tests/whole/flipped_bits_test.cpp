// One bit of one file flips, as a disk or a copy may do: going on and merging believe none.
//
// ECHOCINE_FLIPS sets how many bits flip in each kind of folder.

#include <gtest/gtest.h>

#include <random>

#include "core/error.h"
#include "echo/render_folder.h"
#include "support/faulty_run.h"
#include "support/loop_output.h"
#include "support/loop_scene.h"

namespace echocine {
namespace {

using namespace support;

int flipCount(int otherwise) {
  const char* const wanted = std::getenv("ECHOCINE_FLIPS");
  return wanted ? std::atoi(wanted) : otherwise;
}

using Files = std::map<std::string, std::string>;

Files bytesIn(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[entry.path().lexically_relative(folder).string()] = bytesOf(entry.path());
  return files;
}

// Flips bits of a copy of a finished folder: every file as often as any other, every bit of it too.
class FlippedBits : public testing::Test {
 protected:
  // Flips one bit in a fresh copy and returns the name of the file.
  std::string flipOne(const fs::path& whole) {
    if (of != whole) of = whole, files = bytesIn(whole);
    fs::remove_all(copy);
    fs::copy(whole, copy, fs::copy_options::recursive);
    auto file = files.begin();
    std::advance(file, std::uniform_int_distribution<long>(0, std::ssize(files) - 1)(random));
    if (file->second.empty()) return "";
    std::string bytes = file->second;
    const std::size_t bit =
        std::uniform_int_distribution<std::size_t>(0, 8 * bytes.size() - 1)(random);
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ 1 << bit % 8);
    folder.write("copy/" + file->first, bytes);
    return file->first + ", bit " + std::to_string(bit);
  }
  Outcome run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--quiet", "--threads", "1"});
    return outcomeOf({arguments});
  }

  TempFolder folder;
  const fs::path copy = folder / "copy";
  fs::path of;
  Files files;  // of `of`
  std::mt19937 random{29};
};

TEST_F(FlippedBits, ResumingMakesTheBytesOfAnUndisturbedRun) {
  SceneText text = ballScene(3);
  text.probe["lines"] = "16";
  text.output["png"] = "true";
  text.extra = "[truth]\nwrite = [\"labels\", \"contours\"]\n";
  const std::string scene = writeBall(folder, text);
  ASSERT_EQ(run({"render", scene, "-o", folder / "whole"}).code, 0);
  const Files wanted = leftIn(folder / "whole");
  ASSERT_GT(wanted.size(), 10u);
  int refused = 0;
  const int flips = flipCount(24);
  for (int i = 0; i < flips; ++i) {
    SCOPED_TRACE(flipOne(folder / "whole"));
    const Outcome resumed = run({"render", scene, "-o", copy, "--resume"});
    if (resumed.code != 0) {  // a manifest may have become another scene's
      expectOneLine(resumed, 2);
      ++refused;
      continue;
    }
    expectSame(leftIn(copy), wanted);
  }
  std::printf("%d flips of a render folder, %d refused\n", flips, refused);
}

TEST_F(FlippedBits, AMergeNamesTheFileAndARunMakesTheSameDataset) {
  const fs::path spec =
      folder.write("spec.toml",
                   "name = \"flipped\"\nhearts = 2\nviews = [\"a4c\"]\n"
                   "layouts = [\"native\", \"echonet\", \"nnunet\"]\n" +
                       bytesOf(fs::path(kSourceDir) / "tests/support/small_loops.toml"));
  const fs::path whole = folder / "whole";
  ASSERT_EQ(run({"dataset", spec, "-o", whole}).code, 0);
  const Files wanted = bytesIn(whole);
  int named = 0;
  const int flips = flipCount(8);
  for (int i = 0; i < flips; ++i) {
    const std::string flipped = flipOne(whole);
    if (flipped.empty()) continue;
    SCOPED_TRACE(flipped);
    const Outcome merged = run({"dataset", spec, "-o", copy, "--merge"});
    if (merged.code == 0) {  // a file that the merge itself writes
      EXPECT_TRUE(bytesIn(copy) == wanted);
      continue;
    }
    ++named;
    EXPECT_TRUE(merged.code == 1 || merged.code == 2) << merged.code;
    EXPECT_TRUE(merged.err.starts_with("echocine: ")) << merged.err;
    EXPECT_EQ(merged.err.find("exception"), std::string::npos) << merged.err;
    const Outcome made = run({"dataset", spec, "-o", copy});
    if (made.code == 2) continue;  // its spec is another one
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_TRUE(bytesIn(copy) == wanted);
  }
  EXPECT_GT(named, flips / 4);
  std::printf("%d flips of a dataset, %d named by a merge\n", flips, named);
}

TEST_F(FlippedBits, AReaderOfARenderBelievesNone) {
  SceneText text = ballScene(3);
  text.probe["lines"] = "16";
  text.output["channels"] = R"(["Y", "display.Y"])";
  const std::string scene = writeBall(folder, text);
  ASSERT_EQ(run({"render", scene, "-o", folder / "whole"}).code, 0);
  const echo::EchoLoop wanted = echo::readRenderFolder(folder / "whole");
  ASSERT_EQ(wanted.grey_source, "EXR display.Y");
  const int flips = flipCount(24);
  int refused = 0, left_out = 0;
  for (int i = 0; i < flips; ++i) {
    const std::string flipped = flipOne(folder / "whole");
    SCOPED_TRACE(flipped);
    if (flipped.starts_with("manifest.json") || flipped.starts_with("cine.avi")) {
      EXPECT_THROW(echo::readRenderFolder(copy), SceneError);
      ++refused;
      continue;
    }
    const echo::EchoLoop read = echo::readRenderFolder(copy);
    const bool exr = flipped.starts_with("intensity/");
    EXPECT_EQ(read.grey_source, exr ? "cine.avi" : wanted.grey_source);
    EXPECT_EQ(read.video.frames, wanted.video.frames);
    EXPECT_EQ(read.volumes_ml, wanted.volumes_ml);
    left_out += exr;
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(left_out, 0);
}

}  // namespace
}  // namespace echocine
