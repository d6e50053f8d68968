// However a dataset is cut into tasks, killed or met by failures, finished hearts are the same
// bytes.

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <random>

#include "support/faulty_run.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

using Files = std::map<std::string, std::string>;

// But CAMUS's, which needs two views, and PointOdyssey's, whose many files take long to sync.
constexpr const char* kStart = R"(name = "tasks"
hearts = 3
views = ["a4c"]
layouts = ["echonet", "myotracker", "native", "nnunet", "webdataset"]
track_count = 15
shard_mb = 1
)";

std::string specText() {
  std::string text = kStart + bytesOf(fs::path(kSourceDir) / "tests/support/small_loops.toml");
  const std::string rate = "frame_rate_hz = 10";
  return text.replace(text.find(rate), rate.size(), "frame_rate_hz = 35");  // 32 frames a loop
}

// All but the marks of tasks, which say how a run was cut.
Files filesOf(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (entry.is_regular_file() && !name.starts_with("work/task")) files[name] = bytesOf(entry);
  }
  return files;
}

void expectSame(const Files& made, const Files& wanted) {
  for (const auto& [name, bytes] : wanted) {
    const auto found = made.find(name);
    EXPECT_TRUE(found != made.end()) << name << " is missing";
    if (found != made.end()) {
      EXPECT_TRUE(found->second == bytes) << name << " differs";
    }
  }
  for (const auto& [name, bytes] : made) EXPECT_TRUE(wanted.contains(name)) << name << " is left";
}

int countOf(const char* variable, int otherwise) {
  const char* const wanted = std::getenv(variable);
  return wanted ? std::atoi(wanted) : otherwise;
}

#ifdef ECHOCINE_SANITIZED
constexpr bool kTooSlow = true;
#else
constexpr bool kTooSlow = false;
#endif

class DatasetTasks : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (kTooSlow) return;
    place = std::make_unique<TempFolder>();
    spec = place->write("tasks.toml", specText());
    const Outcome made = outcomeOf(making("whole"), &steps);
    ASSERT_EQ(made.code, 0) << made.err;
    whole = filesOf(*place / "whole");
  }
  static void TearDownTestSuite() { place.reset(); }
  void SetUp() override {
    if (kTooSlow)
      GTEST_SKIP() << "takes an hour; DatasetCommand and DatasetFiles run the same code";
  }

  static FaultyRun making(const std::string& name, const std::vector<std::string>& more = {}) {
    FaultyRun run{
        {"dataset", spec.string(), "-o", (*place / name).string(), "--quiet", "--threads", "1"}};
    run.arguments.insert(run.arguments.end(), more.begin(), more.end());
    return run;
  }

  inline static std::unique_ptr<TempFolder> place;
  inline static fs::path spec;
  inline static Steps steps;
  inline static Files whole;
};

TEST_F(DatasetTasks, ThreeAndSevenTasksMergeToTheBytesOfOne) {
  for (const char* file : {"webdataset/train/shard-000000.tar", "echonet/FileList.csv",
                           "myotracker/train/ec000001_a4c/ec000001_a4c.h5"})
    EXPECT_TRUE(whole.contains(file)) << file;
  for (const int tasks : {3, 7}) {
    SCOPED_TRACE(tasks);
    const std::string name = std::to_string(tasks) + " tasks";
    for (int task = tasks; task >= 1; --task) {  // the last one first
      const std::string part = std::to_string(task) + "/" + std::to_string(tasks);
      const Outcome made = outcomeOf(making(name, {"--task", part}));
      ASSERT_EQ(made.code, 0) << made.err;
    }
    ASSERT_EQ(outcomeOf(making(name, {"--merge"})).code, 0);
    expectSame(filesOf(*place / name), whole);
  }
}

// A shard that a merge writes is proven byte by byte.
TEST_F(DatasetTasks, DamageIsNotPackedIntoAShard) {
  fs::copy(*place / "whole", *place / "damaged", fs::copy_options::recursive);
  const fs::path loop = *place / "damaged/native/ec000002_a4c/loop.json";
  std::string text = bytesOf(loop);
  text[text.size() / 2] ^= 1;
  place->write("damaged/native/ec000002_a4c/loop.json", text);
  const Outcome merged = outcomeOf(making("damaged", {"--merge"}));
  EXPECT_EQ(merged.code, 1);
  EXPECT_NE(merged.err.find("loop.json: was modified"), std::string::npos) << merged.err;
  // By sizes alone the damage is met where the shard is packed.
  const Outcome fast = outcomeOf(making("damaged", {"--merge", "--fast"}));
  EXPECT_EQ(fast.code, 1);
  EXPECT_NE(fast.err.find("loop.json: is not as it was written"), std::string::npos) << fast.err;
  ASSERT_EQ(outcomeOf(making("damaged")).code, 0);
  expectSame(filesOf(*place / "damaged"), whole);
}

// ECHOCINE_KILLS sets how often.
TEST_F(DatasetTasks, KilledAtAnyMomentItGoesOnToTheSameBytes) {
  ASSERT_GT(steps.files, 100);
  const int kills = countOf("ECHOCINE_KILLS", 2);
  std::mt19937 random(11);
  for (int i = 0; i < kills; ++i) {
    const double share = (i + std::uniform_real_distribution<double>()(random)) / kills;
    const long step = 1 + static_cast<long>(share * static_cast<double>(steps.files - 1));
    SCOPED_TRACE(step);
    fs::remove_all(*place / "killed");
    FaultyRun run = making("killed");
    run.fault = "half:" + std::to_string(step);
    EXPECT_EQ(outcomeOf(run).code, 128 + SIGKILL);
    const Outcome again = outcomeOf(making("killed"));
    EXPECT_EQ(again.code, 0) << again.err;
    expectSame(filesOf(*place / "killed"), whole);
  }
}

// ECHOCINE_DATASET_HEARTS sets how many there are; of many, 2 % fail.
TEST_F(DatasetTasks, HeartsThatFailAreListedAndTheOthersAreWhole) {
  const int hearts = countOf("ECHOCINE_DATASET_HEARTS", 3);
  const std::string share = hearts >= 50 ? "0.02" : "0.5";
  std::string text = specText();
  const std::string usual = "hearts = 3";
  text.replace(text.find(usual), usual.size(), "hearts = " + std::to_string(hearts));
  place->write("tasks.toml", text);
  FaultyRun run = making("failing");
  run.limit_s += 20 * static_cast<unsigned>(hearts);
  run.before = [&] { ::setenv("ECHOCINE_FAILING_HEARTS", share.c_str(), 1); };
  const Outcome made = outcomeOf(run);
  ASSERT_EQ(made.code, 0) << made.err;
  const Files files = filesOf(*place / "failing");
  const std::vector<std::string> failed = linesOf(files.at("failed.csv"));
  const auto count = static_cast<int>(failed.size()) - 1;
  std::printf("%d of %d hearts failed\n", count, hearts);
  EXPECT_GT(count, 0);
  EXPECT_LT(count, hearts);
  EXPECT_EQ(static_cast<int>(linesOf(files.at("loops.csv")).size()) - 1, hearts - count);
  // Asked again, those that failed are made, and all is as if nothing had happened.
  ASSERT_EQ(outcomeOf(making("failing")).code, 0);
  const Files mended = filesOf(*place / "failing");
  EXPECT_EQ(linesOf(mended.at("failed.csv")).size(), 1u);
  for (const auto& [name, bytes] : files) {
    if (name.starts_with("native/") || name.starts_with("myotracker/")) {
      EXPECT_TRUE(mended.at(name) == bytes) << name;
    }
  }
  if (hearts == 3) expectSame(mended, whole);
  place->write("tasks.toml", specText());
}

}  // namespace
}  // namespace echocine
