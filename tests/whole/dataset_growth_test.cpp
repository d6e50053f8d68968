// A dataset grows in its folder: more hearts, views and layouts; other changes are refused.

#include <gtest/gtest.h>

#include "support/run_files.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

class DatasetGrowth : public testing::Test {
 protected:
  // Makes a dataset of a spec of these first lines.
  Outcome make(const std::string& name, const std::string& head, const std::string& more = "") {
    const fs::path spec = place.write("spec.toml", "name = \"growth\"\n" + head + rest + more);
    return runShell("%B dataset '" + spec.string() + "' -o '" + (place / name).string() +
                    "' --threads 2");
  }
  std::map<std::string, std::string> made(const std::string& name) const {
    auto files = filesOf(place / name);
    std::erase_if(files, [](const auto& file) { return file.first.starts_with("work/task"); });
    return files;
  }
  void expectRefused(const Outcome& outcome, const std::string& words) const {
    EXPECT_EQ(outcome.code, 2) << outcome.out;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
  }

  TempFolder place;
  const std::string rest = bytesOf(fs::path(kSourceDir) / "tests/support/small_loops.toml");
};

constexpr const char* kTwoHearts = "hearts = 2\nviews = [\"a4c\"]\nlayouts = [\"native\"]\n";

TEST_F(DatasetGrowth, MoreHeartsKeepFinishedOnes) {
  ASSERT_EQ(make("grown", kTwoHearts).code, 0);
  const std::string more = "hearts = [2, 1]\nviews = [\"a4c\"]\nlayouts = [\"native\"]\n";
  const Outcome grown = make("grown", more);
  EXPECT_EQ(grown.code, 0) << grown.err;
  EXPECT_NE(grown.out.find("2 hearts were kept"), std::string::npos) << grown.out;
  ASSERT_EQ(make("fresh", more).code, 0);
  EXPECT_EQ(made("grown"), made("fresh"));
}

// The tables of a dataset that has grown are those of the earlier spec until it is merged.
TEST_F(DatasetGrowth, TheStatusKnowsThatNewHeartsAreNotMerged) {
  ASSERT_EQ(make("grown", kTwoHearts).code, 0);
  const auto status = [&] {
    return runShell("%B dataset --status '" + (place / "grown").string() + "'").out;
  };
  EXPECT_NE(status().find("2 of 2 hearts finished, 0 failed, 0 missing; merged"),
            std::string::npos);
  place.write(
      "spec.toml",
      "name = \"growth\"\nhearts = [2, 1]\nviews = [\"a4c\"]\nlayouts = [\"native\"]\n" + rest);
  const Outcome part = runShell("%B dataset '" + (place / "spec.toml").string() + "' -o '" +
                                (place / "grown").string() + "' --task 1/1 --quiet");
  EXPECT_EQ(part.code, 0) << part.err;
  EXPECT_NE(status().find("3 of 3 hearts finished, 0 failed, 0 missing; not merged"),
            std::string::npos)
      << status();
}

TEST_F(DatasetGrowth, MoreViewsAndLayoutsEndInTheSameBytes) {
  ASSERT_EQ(make("grown", kTwoHearts).code, 0);
  const auto before = made("grown");
  const std::string more =
      "hearts = 2\nviews = [\"a2c\", \"a4c\"]\nlayouts = [\"native\", \"echonet\"]\n";
  const Outcome grown = make("grown", more);
  EXPECT_EQ(grown.code, 0) << grown.err;
  EXPECT_EQ(grown.err.find("rendered again"), std::string::npos) << grown.err;
  ASSERT_EQ(make("fresh", more).code, 0);
  const auto after = made("grown");
  EXPECT_EQ(after, made("fresh"));
  for (const char* file : {"cine.avi", "truth.npz"})
    EXPECT_EQ(after.at(std::string("native/ec000001_a4c/") + file),
              before.at(std::string("native/ec000001_a4c/") + file));
}

TEST_F(DatasetGrowth, ViewsInAnotherOrderEndInTheSameBytes) {
  ASSERT_EQ(make("grown", "hearts = 1\nviews = [\"a4c\", \"a2c\"]\n").code, 0);
  const std::string other = "hearts = 1\nviews = [\"a2c\", \"a4c\"]\n";
  const Outcome grown = make("grown", other);
  EXPECT_EQ(grown.code, 0) << grown.err;
  ASSERT_EQ(make("fresh", other).code, 0);
  EXPECT_EQ(made("grown"), made("fresh"));
}

// The name of a dataset is that of its file, which may be in another encoding.
TEST_F(DatasetGrowth, ASpecWhoseNameIsNoUtf8IsMerged) {
  const fs::path spec =
      place.write("caf\xe9.toml", "hearts = 1\nviews = [\"a4c\"]\nlayouts = [\"native\"]\n" + rest);
  const Outcome made =
      runShell("%B dataset '" + spec.string() + "' -o '" + (place / "made").string() + "' --quiet");
  EXPECT_EQ(made.code, 0) << made.err;
  EXPECT_TRUE(fs::exists(place / "made/dataset.json"));
}

TEST_F(DatasetGrowth, WhatChangesALoopIsRefusedByItsKey) {
  ASSERT_EQ(make("grown", kTwoHearts).code, 0);
  const auto before = made("grown");
  expectRefused(make("grown", kTwoHearts, "\n[subject]\nage = 50\n"), "subject.age: absent -> 50");
  expectRefused(make("grown", std::string("seed = 7\n") + kTwoHearts), "seed: absent -> 7");
  expectRefused(make("grown", "hearts = 1\nviews = [\"a4c\"]\n"), "hearts: 1 are fewer");
  expectRefused(make("grown", "hearts = 2\nviews = [\"a2c\"]\n"), "views:");
  expectRefused(make("grown", "hearts = 2\nviews = [\"a4c\"]\nlayouts = [\"echonet\"]\n"),
                "layouts:");
  expectRefused(make("grown",
                     "hearts = 2\nviews = [\"a4c\"]\n"
                     "layouts = [\"native\", \"pointodyssey\"]\n"),
                "tracks");
  EXPECT_EQ(made("grown"), before);
}

TEST_F(DatasetGrowth, AMovedSplitIsRefused) {
  const std::string split = "\n[split]\ntrain = 50\ntest = 50\n";
  ASSERT_EQ(make("grown", kTwoHearts, split).code, 0);
  expectRefused(make("grown", "hearts = 4\nviews = [\"a4c\"]\n", split), "hearts = [2, 2]");
}

}  // namespace
}  // namespace echocine
