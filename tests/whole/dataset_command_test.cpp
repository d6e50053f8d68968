// echocine dataset: the same bytes whatever the tasks and threads and however often it is killed;
// what it refuses; and that its layouts are as their loaders want them.

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "support/page_data.h"
#include "support/run_files.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

constexpr const char* kHead = R"(name = "tiny"
hearts = 2
views = ["a4c"]
layouts = ["native", "echonet"]
)";

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
  const fs::path spec = folder.write(
      "tiny.toml", kHead + bytesOf(fs::path(kSourceDir) / "tests/support/small_loops.toml"));
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
  EXPECT_EQ(list[0],
            "FileName,EF,ESV,EDV,FrameHeight,FrameWidth,FPS,NumberOfFrames,Split,EFTracing,"
            "ESVTracing,EDVTracing,EFExact,ESVExact,EDVExact");
  const std::vector<std::string> tracings = linesOf(bytesOf(root / "echonet/VolumeTracings.csv"));
  ASSERT_EQ(tracings.size(), 1 + 2 * 2 * 21u);
  EXPECT_EQ(tracings[0], "FileName,X1,Y1,X2,Y2,Frame");
  for (std::size_t v = 0; v < 2; ++v) {
    const std::vector<std::string> row = fieldsOf(list[v + 1]);
    ASSERT_EQ(row.size(), 15u);
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
  EXPECT_NE(outcome.err.find("holds unrelated files"), std::string::npos) << outcome.err;
  EXPECT_EQ(filesOf(folder / "other").size(), 1u);
  for (const char* const task : {"0/2", "3/2", "1", "a/b"})
    EXPECT_EQ(make("new", std::string("--task ") + task).code, 2) << task;
  EXPECT_FALSE(fs::exists(folder / "new"));
}

// The lists are there, but a dataset without a heart is a failure.
TEST_F(DatasetCommand, HeartsThatFailAreListed) {
  const Outcome made = make("failing", "", "ECHOCINE_FAILING_HEARTS=1");
  EXPECT_EQ(made.code, 1);
  EXPECT_NE(made.err.find("all 2 hearts failed"), std::string::npos) << made.err;
  const std::vector<std::string> lines = linesOf(bytesOf(folder / "failing/failed.csv"));
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_EQ(lines[1], "1,1,made to fail by ECHOCINE_FAILING_HEARTS");
}

// Width and height in a PNG's first chunk, big-endian (PNG, 11.2.2).
std::pair<int, int> sizeOfPng(const std::string& png) {
  const auto at = [&](std::size_t place) {
    int value = 0;
    for (std::size_t i = 0; i < 4; ++i)
      value = value << 8 | static_cast<unsigned char>(png[place + i]);
    return value;
  };
  return {at(16), at(20)};
}

TEST_F(DatasetCommand, APreviewIsAPageAndASheetAndLeavesNothingElse) {
  const Outcome made = make("look.html", "--preview 2");
  ASSERT_EQ(made.code, 0) << made.err;
  std::set<std::string> names;
  for (const auto& [name, bytes] : filesOf(folder.path())) names.insert(name);
  EXPECT_EQ(names, (std::set<std::string>{"look.html", "look.png", "tiny.toml"}));
  // Two pairs, one above the other, of two pictures of 224 pixels each.
  EXPECT_EQ(sizeOfPng(bytesOf(folder / "look.png")), std::pair(448, 448));
}

// The sheet's ejection fraction is the one that the dataset's table has for the same heart.
TEST_F(DatasetCommand, APreviewShowsTheHeartsThatAreMade) {
  ASSERT_EQ(make("look.html", "--preview 2").code, 0);
  ASSERT_EQ(make("whole").code, 0);
  const nlohmann::json data = dataOf(bytesOf(folder / "look.html"));
  const std::vector<std::string> rows = linesOf(bytesOf(folder / "whole/loops.csv"));
  const std::vector<std::string> head = fieldsOf(rows[0]);
  const auto column = std::find(head.begin(), head.end(), "ef_percent") - head.begin();
  ASSERT_EQ(data["previews"].size(), 2u);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(data["previews"][i]["ef_percent"].get<double>(),
                std::stod(fieldsOf(rows[i + 1])[static_cast<std::size_t>(column)]), 1e-9);
}

TEST_F(DatasetCommand, APreviewIsRefusedWhereItIsNoPageOrOneOfManyParts) {
  EXPECT_EQ(make("look", "--preview 2").code, 2);
  EXPECT_EQ(make("look.html", "--preview 0").code, 2);
  EXPECT_EQ(make("look.html", "--preview 2 --task 1/2").code, 2);
  EXPECT_EQ(filesOf(folder.path()).size(), 1u);
}

// A scheduler of one machine: sbatch writes the job down and runs it at once, each task of an array
// in turn. The second run of the first task stands for a requeue.
constexpr const char* kSbatch = R"(#!/bin/sh
for last; do :; done
echo "$@" >> "$JOBS"
tasks=$(sed -n 's/^#SBATCH --array=1-//p' "$last")
if [ -z "$tasks" ]; then sh "$last" || exit 1; else
  for SLURM_ARRAY_TASK_ID in 1 $(seq "$tasks"); do export SLURM_ARRAY_TASK_ID; sh "$last" || exit 1; done
fi
echo "17;cluster"
)";

TEST_F(DatasetCommand, JobsOfSlurmMakeTheSameBytes) {
  fs::create_directory(folder / "bin");
  folder.write("bin/sbatch", kSbatch);
  fs::permissions(folder / "bin/sbatch", fs::perms::owner_all);
  const std::string before = "PATH='" + (folder / "bin").string() + "':\"$PATH\" JOBS='" +
                             (folder / "jobs").string() + "'";
  const Outcome made =
      make("by slurm", "--slurm --tasks 2 --cores 1 --minutes 5 --sbatch '--partition=cpu --nice'",
           before);
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string logs = "--parsable --output=" + (folder / "by slurm/slurm").string();
  EXPECT_EQ(linesOf(bytesOf(folder / "jobs")),
            (std::vector<std::string>{
                logs + "/array_%A_%a.log --partition=cpu --nice array.sh",
                logs + "/merge_%j.log --partition=cpu --nice --dependency=afterany:17 merge.sh"}));
  ASSERT_EQ(make("at once").code, 0);
  const auto ofTheDataset = [&](const char* name) {
    std::map<std::string, std::string> files = filesOf(folder / name);
    std::erase_if(files, [](const auto& file) {
      return file.first.starts_with("work/task") || file.first.starts_with("slurm/");
    });
    return files;
  };
  EXPECT_EQ(ofTheDataset("by slurm"), ofTheDataset("at once"));
}

// The program is a shell script here in the place of a container's runtime.
TEST_F(DatasetCommand, TheRecipeForContainersMakesTheSameBytes) {
  fs::create_directory(folder / "bin");
  folder.write("bin/sbatch", kSbatch);
  const std::string page = bytesOf(fs::path(kSourceDir) / "src/dataset/README.md");
  const std::string start = "    sed -i 's#^";
  const std::size_t at = page.find(start);
  ASSERT_NE(at, std::string::npos);
  std::string recipe = page.substr(at, page.find('\n', at) - at);
  const std::string in = (folder / "in").string(), word = "FOLDER";
  for (std::size_t found = 0; (found = recipe.find(word, found)) != std::string::npos;)
    recipe.replace(found, word.size(), in);
  folder.write("bin/apptainer",
               "#!/bin/sh\necho \"$1 $2 $3\" >> \"$JOBS\"\nshift 3\nexec \"$PROGRAM\" \"$@\"\n");
  for (const char* name : {"bin/sbatch", "bin/apptainer"})
    fs::permissions(folder / name, fs::perms::owner_all);
  ASSERT_EQ(make("in", "--slurm --no-submit --tasks 2 --minutes 5").code, 0);
  const Outcome made = runShell(recipe + " && PROGRAM=%B PATH='" + (folder / "bin").string() +
                                "':\"$PATH\" JOBS='" + (folder / "jobs").string() + "' sh '" +
                                (folder / "in/slurm/submit.sh").string() + "'");
  ASSERT_EQ(made.code, 0) << made.err;
  const std::string jobs = bytesOf(folder / "jobs");
  const std::string call = "exec /path/to/echocine.sif echocine\n";
  std::size_t calls = 0;
  for (std::size_t found = 0; (found = jobs.find(call, found)) != std::string::npos; ++found)
    ++calls;
  EXPECT_EQ(calls, 4u) << jobs;  // the first task twice, the second, the merge
  ASSERT_EQ(make("at once").code, 0);
  EXPECT_EQ(bytesOf(folder / "in/loops.csv"), bytesOf(folder / "at once/loops.csv"));
  EXPECT_EQ(bytesOf(folder / "in/README.md"), bytesOf(folder / "at once/README.md"));
}

TEST_F(DatasetCommand, JobsThatCannotBeSubmittedAreWritten) {
  const Outcome made = make("own", "--slurm --tasks 5 --minutes 7", "PATH=/nowhere");
  EXPECT_EQ(made.code, 1);
  const Outcome written = make("own", "--slurm --no-submit --tasks 5 --minutes 7");
  ASSERT_EQ(written.code, 0) << written.err;
  const std::string array = bytesOf(folder / "own/slurm/array.sh");
  EXPECT_NE(array.find("#SBATCH --array=1-2\n"), std::string::npos)
      << array;  // no more than hearts
  EXPECT_NE(array.find("#SBATCH --time=7\n"), std::string::npos);
  EXPECT_NE(array.find("#SBATCH --cpus-per-task=1\n"), std::string::npos);  // no more than hearts
  EXPECT_EQ(make("own", "--no-submit").code, 2);
  EXPECT_EQ(make("own", "--tasks 3").code, 2);
}

}  // namespace
}  // namespace echocine
