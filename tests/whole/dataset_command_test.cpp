// echocine dataset: the same bytes whatever the tasks and threads and however often it is killed;
// what it refuses; and that its layouts are as their loaders want them.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <sstream>

#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

constexpr const char* kSpec = R"(name = "tiny"
hearts = 2
views = ["a4c"]
layouts = ["native", "echonet"]
keyframes = 8
picture_px = 112
[heart]
edv = { uniform = [90, 150] }
ef = { uniform = [0.4, 0.65] }
[scene.probe]
lines = 48
samples = 128
[scene.acquisition]
frame_rate_hz = 10
[scene.signal]
look = "paper"
)";

// Every file but the book-keeping of tasks, which differs by how a run was cut into parts.
std::map<std::string, std::string> filesOf(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file())
      files[fs::relative(entry.path(), folder).string()] = bytesOf(entry.path());
  return files;
}

std::vector<std::string> fieldsOf(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream in(line);
  for (std::string field; std::getline(in, field, ',');) fields.push_back(field);
  return fields;
}

class DatasetCommand : public testing::Test {
 protected:
  Outcome make(const std::string& name, const std::string& options = "",
               const std::string& before = "") const {
    return runShell(before + " %B dataset '" + spec.string() + "' -o '" + (folder / name).string() +
                    "' --quiet " + options);
  }
  TempFolder folder;
  const fs::path spec = folder.write("tiny.toml", kSpec);
};

// Frames in an AVI's main header: dwTotalFrames, 48 bytes in (Microsoft, AVIMAINHEADER).
std::uint32_t framesInHeader(const std::string& avi) {
  std::uint32_t frames = 0;
  std::copy_n(avi.begin() + 48, 4, reinterpret_cast<char*>(&frames));
  return frames;
}

void expectEchonet(const fs::path& root) {
  const std::vector<std::string> list = linesOf(bytesOf(root / "echonet/FileList.csv"));
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0], "FileName,EF,ESV,EDV,FrameHeight,FrameWidth,FPS,NumberOfFrames,Split");
  const std::vector<std::string> tracings = linesOf(bytesOf(root / "echonet/VolumeTracings.csv"));
  ASSERT_EQ(tracings.size(), 1 + 2 * 2 * 21u);
  EXPECT_EQ(tracings[0], "FileName,X1,Y1,X2,Y2,Frame");
  for (std::size_t v = 0; v < 2; ++v) {
    const std::vector<std::string> row = fieldsOf(list[v + 1]);
    ASSERT_EQ(row.size(), 9u);
    EXPECT_EQ(row[0].find('.'), std::string::npos);
    const double ef = std::stod(row[1]), esv = std::stod(row[2]), edv = std::stod(row[3]);
    EXPECT_NEAR(ef, 100 * (1 - esv / edv), 1e-3);
    EXPECT_EQ(row[4] + row[5], "112112");
    EXPECT_EQ(std::to_string(framesInHeader(bytesOf(root / "echonet/Videos" / (row[0] + ".avi")))),
              row[7]);
    const std::vector<std::string> small = fieldsOf(tracings[1 + 42 * v]),
                                   large = fieldsOf(tracings[1 + 42 * v + 21]);
    EXPECT_EQ(small[0], row[0] + ".avi");
    EXPECT_GT(std::stoi(small[5]), std::stoi(large[5]));  // end-systole first in the file
  }
}

TEST_F(DatasetCommand, TasksThreadsAndDamageGiveTheSameBytes) {
  ASSERT_EQ(make("whole", "--threads 2").code, 0);
  expectEchonet(folder / "whole");
  const auto whole = filesOf(folder / "whole");

  // In two parts, serially; before the second one nothing can be merged.
  ASSERT_EQ(make("parts", "--threads 1 --task 2/2").code, 0);
  const Outcome early = make("parts", "--merge");
  EXPECT_EQ(early.code, 1);
  EXPECT_NE(early.err.find("1 of 2 hearts are missing"), std::string::npos) << early.err;
  ASSERT_EQ(make("parts", "--threads 1 --task 1/2").code, 0);
  ASSERT_EQ(make("parts", "--merge").code, 0);
  EXPECT_EQ(filesOf(folder / "parts"), whole);

  // A file that is not what was written, and a heart of which the record was never written.
  folder.write("parts/native/ec000001_a4c/cine.avi", "damaged");
  const std::string record = "parts/work/0000/0000001.json";
  fs::remove(folder / record);
  ASSERT_EQ(make("parts").code, 0);
  EXPECT_EQ(filesOf(folder / "parts"), whole);
}

TEST_F(DatasetCommand, AnotherSpecsFolderIsLeftAlone) {
  fs::create_directories(folder / "other");
  folder.write("other/letter.txt", "mine");
  const Outcome outcome = make("other");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("holds files of something else"), std::string::npos) << outcome.err;
  EXPECT_EQ(filesOf(folder / "other").size(), 1u);
  for (const char* const task : {"0/2", "3/2", "1", "a/b"})
    EXPECT_EQ(make("new", std::string("--task ") + task).code, 2) << task;
  EXPECT_FALSE(fs::exists(folder / "new"));
}

TEST_F(DatasetCommand, HeartsThatFailAreListedAndEndNothing) {
  ASSERT_EQ(make("failing", "", "ECHOCINE_FAILING_HEARTS=1").code, 0);
  const std::vector<std::string> lines = linesOf(bytesOf(folder / "failing/failed.csv"));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[1], "1,1,made to fail by ECHOCINE_FAILING_HEARTS");
}

}  // namespace
}  // namespace echocine
