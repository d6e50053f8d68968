// Finished datasets are joined: names apart, lists concatenated, splits kept; clashes are refused.

#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "support/run_files.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

constexpr const char* kLayouts =
    "layouts = [\"camus\", \"echonet\", \"native\", \"nnunet\", \"webdataset\"]\n";
constexpr const char* kViews = "views = [\"a2c\", \"a4c\"]\n";

class DatasetJoin : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    place = std::make_unique<TempFolder>();
    const std::string split = "\n[split]\ntrain = 50\nval = 0\ntest = 50\n";
    ASSERT_EQ(make("one", std::string("name = \"one\"\nhearts = 2\n") + kViews + kLayouts, split),
              "");
    ASSERT_EQ(make("two",
                   std::string("name = \"two\"\nlicence = \"CC-BY-4.0\"\nseed = 7\nhearts = 3\n") +
                       kViews + kLayouts,
                   split),
              "");
  }
  static void TearDownTestSuite() { place.reset(); }

  // The error of a run, empty if it succeeds.
  static std::string make(const std::string& name, const std::string& head,
                          const std::string& more = "") {
    const std::string rest = bytesOf(fs::path(kSourceDir) / "tests/support/small_loops.toml");
    const fs::path spec = place->write(name + ".toml", head + rest + more);
    const Outcome outcome = runShell("%B dataset '" + spec.string() + "' -o '" +
                                     (*place / name).string() + "' --threads 2 --quiet");
    return outcome.code == 0 ? "" : outcome.err;
  }
  static Outcome join(const std::string& parts, const std::string& to) {
    return runShell("cd '" + place->path().string() + "' && %B dataset --join " + parts + " -o " +
                    to);
  }
  static void expectRefused(const std::string& parts, const std::string& words) {
    const Outcome outcome = join(parts, "refused");
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(linesOf(outcome.err).size(), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find(words), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(*place / "refused"));
  }
  static std::string text(const std::string& name) { return bytesOf(*place / name); }
  static std::vector<std::string> lines(const std::string& name) { return linesOf(text(name)); }
  // Lines of both lists: the head once.
  static std::vector<std::string> linesOfBoth(const std::string& name) {
    std::vector<std::string> all = lines("one/" + name);
    const std::vector<std::string> more = lines("two/" + name);
    all.insert(all.end(), more.begin() + 1, more.end());
    return all;
  }
  static std::string renumbered(std::string line) {
    for (int heart = 3; heart >= 1; --heart) {
      const std::string from = "ec00000" + std::to_string(heart),
                        to = "ec00000" + std::to_string(heart + 2);
      for (std::size_t at = 0; (at = line.find(from, at)) != std::string::npos; at += to.size())
        line.replace(at, from.size(), to);
    }
    return line;
  }

  inline static std::unique_ptr<TempFolder> place;
};

TEST_F(DatasetJoin, ListsAreConcatenatedAndFilesKeepTheirBytes) {
  const Files before = filesOf(*place / "two");
  const Outcome made = join("one two", "joined");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NE(made.out.find("5 hearts, 10 loops"), std::string::npos) << made.out;
  EXPECT_EQ(filesOf(*place / "two"), before);
  for (const char* name : {"echonet/FileList.csv", "echonet/VolumeTracings.csv"}) {
    std::vector<std::string> wanted = linesOfBoth(name);
    const std::size_t first = lines(std::string("one/") + name).size();
    for (std::size_t i = first; i < wanted.size(); ++i) wanted[i] = renumbered(wanted[i]);
    EXPECT_EQ(lines(std::string("joined/") + name), wanted) << name;
  }
  EXPECT_EQ(text("joined/native/ec000001_a4c/loop.json").find("\"joined\""),
            text("joined/native/ec000001_a4c/loop.json").rfind("\"joined\""));
  for (const char* file : {"cine.avi", "truth.npz"})
    EXPECT_EQ(text(std::string("joined/native/ec000004_a2c/") + file),
              text(std::string("two/native/ec000002_a2c/") + file));
  EXPECT_EQ(text("joined/camus/database_nifti/patient0005/patient0005_4CH_ES_gt.nii.gz"),
            text("two/camus/database_nifti/patient0003/patient0003_4CH_ES_gt.nii.gz"));
  EXPECT_EQ(text("joined/camus/database_split/subgroup_training.txt"),
            "patient0001\npatient0003\npatient0004\n");
  EXPECT_EQ(text("joined/camus/database_split/subgroup_testing.txt"), "patient0002\npatient0005\n");
}

TEST_F(DatasetJoin, TablesAndFoldsNameThePart) {
  ASSERT_EQ(join("one two", "joined").code, 0);
  const auto loop = nlohmann::json::parse(text("joined/native/ec000003_a4c/loop.json"));
  EXPECT_EQ(loop["id"], "ec000003_a4c");
  EXPECT_EQ(loop["heart"], 3);
  EXPECT_EQ(loop["joined"]["id"], "ec000001_a4c");
  EXPECT_EQ(loop["joined"]["dataset"], "two");
  const auto dataset = nlohmann::json::parse(text("joined/dataset.json"));
  EXPECT_EQ(dataset["name"], "one + two");
  EXPECT_EQ(dataset["licence"], "CC0-1.0 AND CC-BY-4.0");
  EXPECT_EQ(dataset["counts"]["loops"], 10);
  EXPECT_EQ(dataset["parts"][1]["first_heart"], 3);
  EXPECT_EQ(dataset["parts"][1]["seed"], 7);
  EXPECT_EQ(text("joined/specs/part_2.toml"), text("two.toml"));
  const auto splits = nlohmann::json::parse(text("joined/splits.json"));
  EXPECT_EQ(splits["test"], (std::vector<std::string>{"ec000002_a2c", "ec000002_a4c",
                                                      "ec000005_a2c", "ec000005_a4c"}));
  // Three hearts for training: three folds, with no heart in both of their sides.
  const auto folds = nlohmann::json::parse(
      text("joined/nnunet/nnUNet_preprocessed/Dataset501_EchoCine/splits_final.json"));
  ASSERT_EQ(folds.size(), 3u);
  for (const auto& fold : folds) {
    EXPECT_EQ(fold["val"].size(), 4u);
    EXPECT_EQ(fold["train"].size(), 8u);
  }
  for (const auto& name : folds[2]["val"])
    EXPECT_TRUE(fs::exists(*place / "joined/nnunet/nnUNet_raw/Dataset501_EchoCine/labelsTr" /
                           (name.get<std::string>() + ".png")));
}

TEST_F(DatasetJoin, ANameReplacesThoseOfTheParts) {
  const Outcome made = join("one two --name 'Both \"hands\"'", "named");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_EQ(nlohmann::json::parse(text("named/dataset.json"))["name"], "Both \"hands\"");
  EXPECT_EQ(lines("named/README.md").front(), "# Both \"hands\"");
  // Only the documents of the whole have the name: another one resumes the join.
  Files named = filesOf(*place / "named");
  ASSERT_EQ(join("one two", "named").code, 0);
  Files unnamed = filesOf(*place / "named");
  for (const char* name : {"README.md", "dataset.json"}) {
    EXPECT_NE(named.at(name), unnamed.at(name));
    named.erase(name), unnamed.erase(name);
  }
  EXPECT_EQ(named, unnamed);
  expectRefused("one two --name ''", "--name: is empty");
  expectRefused("one two --name \"$(printf 'a\\nb')\"", "--name: is empty or has control");
  const Outcome alone = runShell("%B dataset --name x -o y");
  EXPECT_EQ(alone.code, 2) << alone.err;
  EXPECT_NE(alone.err.find("--join"), std::string::npos) << alone.err;
}

TEST_F(DatasetJoin, AnInterruptedJoinResumesToTheSameBytes) {
  ASSERT_EQ(join("one two", "joined").code, 0);
  const Files wanted = filesOf(*place / "joined");
  ASSERT_EQ(join("one two", "again").code, 0);
  EXPECT_EQ(filesOf(*place / "again"), wanted);
  fs::remove(*place / "again/native/ec000004_a2c/cine.avi");
  fs::remove(*place / "again/loops.csv");
  place->write("again/native/ec000001_a2c/truth.npz", "damaged");
  ASSERT_EQ(join("one two", "again").code, 0);
  EXPECT_EQ(filesOf(*place / "again"), wanted);
  EXPECT_EQ(join("two one", "again").code, 2);  // another join
  // Neither a part of another join, nor a folder for a run.
  expectRefused("one joined", "joined is itself joined");
  const Outcome run = runShell("%B dataset '" + (*place / "one.toml").string() + "' -o '" +
                               (*place / "joined").string() + "'");
  EXPECT_EQ(run.code, 2);
  EXPECT_NE(run.err.find("holds joined datasets"), std::string::npos) << run.err;
  const Outcome status = runShell("%B dataset --status '" + (*place / "joined").string() + "'");
  EXPECT_EQ(status.code, 2);
  EXPECT_NE(status.err.find("holds joined datasets"), std::string::npos) << status.err;
}

TEST_F(DatasetJoin, ClashesAreRefusedByName) {
  ASSERT_EQ(make("copy", std::string("name = \"copy\"\nhearts = 3\n") + kViews + kLayouts), "");
  expectRefused("one copy", "heart 1 of one and heart 1 of copy are the same heart");
  // In another look it is still the same heart.
  ASSERT_EQ(
      make("look", "hearts = 1\nviews = [\"a4c\"]\nlayouts = [\"echonet\"]\n", "gain_db = 3\n"),
      "");
  expectRefused("two look one", "heart 1 of look and heart 1 of one are the same heart");
  expectRefused("one one", "one twice");
  for (const char* inside : {"one", "one/joined", "two/../two/native"}) {
    const Outcome outcome = join("one two", inside);
    EXPECT_EQ(outcome.code, 2);
    EXPECT_NE(outcome.err.find("is in the part"), std::string::npos) << outcome.err;
  }
  EXPECT_FALSE(fs::exists(*place / "one/joined"));
  expectRefused("one", "--join");
  expectRefused("one absent", "absent holds no dataset");
  ASSERT_EQ(make("exact", "seed = 3\nhearts = 1\nviews = [\"a4c\"]\nlayouts = [\"echonet\"]\n",
                 "[ef]\nechonet = \"exact\"\n"),
            "");
  expectRefused("one exact", "one and exact differ in ef.echonet");
  ASSERT_EQ(
      make("still", "seed = 4\nhearts = 1\nviews = [\"a4c\"]\nlayouts = [\"pointodyssey\"]\n"), "");
  expectRefused("one still", "one and still have no common layout");
}

TEST_F(DatasetJoin, OnlyCommonLayoutsAreJoined) {
  ASSERT_EQ(make("small", "seed = 9\nhearts = 1\nviews = [\"a4c\"]\nlayouts = [\"echonet\"]\n"),
            "");
  const Outcome made = join("small one", "lesser");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NE(made.out.find("left out, because not all parts have them: camus, native, nnunet"),
            std::string::npos)
      << made.out;
  EXPECT_FALSE(fs::exists(*place / "lesser/native"));
  EXPECT_TRUE(fs::exists(*place / "lesser/echonet/Videos/ec000003_a2c.avi"));
  EXPECT_EQ(lines("lesser/echonet/FileList.csv").size(), 1u + 1 + 4);
}

TEST_F(DatasetJoin, DamagedAndUnfinishedPartsAreNamed) {
  ASSERT_EQ(make("hurt", "seed = 11\nhearts = 1\nviews = [\"a4c\"]\nlayouts = [\"echonet\"]\n"),
            "");
  const std::string video = text("hurt/echonet/Videos/ec000001_a4c.avi");
  std::string other = video;
  other[other.size() / 2] = static_cast<char>(other[other.size() / 2] ^ 1);
  place->write("hurt/echonet/Videos/ec000001_a4c.avi", other);
  const Outcome damaged = join("one hurt", "from_damaged");
  EXPECT_EQ(damaged.code, 1);
  EXPECT_NE(damaged.err.find("ec000001_a4c.avi: was modified"), std::string::npos) << damaged.err;
  fs::remove(*place / "hurt/echonet/Videos/ec000001_a4c.avi");
  expectRefused("one hurt", "1 of 1 hearts of hurt are missing");
}

}  // namespace
}  // namespace echocine
