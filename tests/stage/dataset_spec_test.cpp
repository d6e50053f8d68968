// What a spec of a dataset may say, and the words by which the rest is refused.

#include <gtest/gtest.h>

#include <filesystem>

#include "core/error.h"
#include "dataset/spec.h"
#include "dataset/structure_labels.h"
#include "support/paths.h"

namespace echocine::dataset {
namespace {

const std::string kStart = "hearts = 4\nviews = [\"a4c\"]\n";

void expectRefused(const std::string& text, const std::vector<std::string>& words) {
  try {
    parseSpec(text, "spec.toml");
    ADD_FAILURE() << "accepted: " << text;
  } catch (const SceneError& error) {
    const std::string line = error.what();
    EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    for (const std::string& word : words)
      EXPECT_NE(line.find(word), std::string::npos) << word << " in " << line;
  }
}

TEST(DatasetSpec, WhatIsWrongIsNamedWithWhatIsAccepted) {
  expectRefused("views = [\"a4c\"]\n", {"hearts", "is missing"});
  expectRefused("hearts = 0\nviews = [\"a4c\"]\n", {"spec.toml:1", "hearts", "1 to"});
  expectRefused("hearts = 4\nviews = [\"a5c\"]\n", {"views", "a5c", "a4c, a2c"});
  expectRefused(kStart + "[heart]\nejection = 0.5\n", {"heart.ejection", "not a known key"});
  expectRefused(kStart + "[heart]\nef = { uniform = [0.5, 0.95] }\n",
                {"spec.toml:4", "heart.ef", "0.95", "0.05 to 0.85"});
  expectRefused(kStart + "[heart]\nef = { gamma = [0.5, 0.6] }\n", {"heart.ef", "uniform"});
  expectRefused(kStart + "[heart]\nef = { normal = [0.5, 0.1] }\n", {"within", "is missing"});
  expectRefused(kStart + "[heart]\nhr = { choice = [60, 80], weights = [0.5, 0.6] }\n",
                {"heart.hr.weights", "sum to 1.1"});
  expectRefused(kStart + "[populations]\nhealthy = 0.5\n", {"populations", "sum to 0.5"});
  // Drawn with the ejection fraction of the infarct.
  expectRefused(kStart +
                    "[populations]\ninfarct_lad = 1\n[[correlated]]\n"
                    "parameters = [\"heart.segments.lad.amplitude\", \"heart.hr\"]\n"
                    "correlations = [0.9]\n",
                {"heart.segments.lad.amplitude", "not drawn by itself"});
  expectRefused(kStart + "[populations]\nathletes = 1\n", {"athletes", "healthy", "dilated"});
  expectRefused(kStart + "[heart.segments.lap]\namplitude = 0\n", {"lap", "lad"});
  expectRefused(kStart + "[offset]\ntilt_deg = 80\n", {"offset.tilt_deg", "-60 to 60"});
  expectRefused(kStart + "[[correlated]]\nparameters = [\"heart.ef\", \"heart.hr\"]\n",
                {"heart.ef", "not drawn"});
}

TEST(DatasetSpec, EjectionFractionsAreThoseOfTracingsUnlessExact) {
  EXPECT_FALSE(parseSpec(kStart + "layouts = [\"echonet\"]\n", "spec.toml").hasExactEf("echonet"));
  EXPECT_TRUE(
      parseSpec(kStart + "layouts = [\"echonet\"]\n[ef]\nechonet = \"exact\"\n", "spec.toml")
          .hasExactEf("echonet"));
  expectRefused(kStart + "layouts = [\"echonet\"]\n[ef]\nechonet = \"best\"\n",
                {"ef.echonet", "tracing", "exact"});
  expectRefused(kStart + "[ef]\nechonet = \"exact\"\n", {"ef.echonet", "layouts"});
  expectRefused(kStart + "[ef]\nnative = \"exact\"\n", {"native"});
}

TEST(DatasetSpec, NnunetCanHaveAllStructures) {
  const std::string nnunet = kStart + "layouts = [\"nnunet\"]\n";
  EXPECT_FALSE(parseSpec(nnunet, "spec.toml").nnunet_all);
  EXPECT_FALSE(parseSpec(nnunet + "[nnunet]\nstructures = \"camus\"\n", "spec.toml").nnunet_all);
  EXPECT_TRUE(parseSpec(nnunet + "[nnunet]\nstructures = \"all\"\n", "spec.toml").nnunet_all);
  expectRefused(nnunet + "[nnunet]\nstructures = \"most\"\n",
                {"nnunet.structures", "camus", "all"});
  expectRefused(nnunet + "[nnunet]\nlabels = \"all\"\n", {"nnunet.labels", "structures"});
  expectRefused(kStart + "[nnunet]\nstructures = \"all\"\n", {"nnunet.structures", "layouts"});
}

TEST(DatasetSpec, LabelsOfAllStructuresStartWithThoseOfCamus) {
  const auto names = structureLabelNames();
  const auto numbers = structureNumbers();
  ASSERT_EQ(names.size(), numbers.size() + 1);
  for (std::size_t i = 0; i < numbers.size(); ++i)
    EXPECT_EQ(numbers[i].second, static_cast<int>(i) + 1);
  for (const int label : {0, 1, 2, 3})
    EXPECT_EQ(camusLabel(static_cast<std::uint8_t>(label)), label);
  for (std::size_t label = 4; label < names.size(); ++label)
    EXPECT_EQ(camusLabel(static_cast<std::uint8_t>(label)),
              std::string(names[label]) == "papillary_muscle" ? 1 : 0)
        << names[label];
}

TEST(DatasetSpec, SceneKeysAreTriedAtTheirEnds) {
  expectRefused(kStart + "[scene.signal]\ngain_db = { uniform = [0, 500] }\n",
                {"spec.toml:4", "signal.gain_db", "500", "accepted"});
  expectRefused(kStart + "[scene.signal]\ngain = 3\n", {"signal.gain"});
  expectRefused(kStart + "[scene.signal]\nlook = \"paper\"\nquality = \"good\"\n",
                {"signal.quality"});
  expectRefused(kStart + "[scene.structure]\nname = \"x\"\n", {"scene.structure"});
}

TEST(DatasetSpec, LayoutsThatCannotHoldTheLoopsAreRefused) {
  expectRefused(kStart + "layouts = [\"camus\"]\n", {"camus", "a2c"});
  expectRefused(kStart + "layouts = [\"minc\"]\n", {"minc", "echonet"});
  expectRefused("hearts = 4\nviews = [\"psax-mid\"]\nlayouts = [\"echonet\"]\n",
                {"echonet", "a4c"});
}

TEST(DatasetSpec, LoopsTooShortForMyotrackerAreRefusedWhereAnyMayBe) {
  const std::string start = kStart + "layouts = [\"myotracker\"]\n";
  EXPECT_NO_THROW(parseSpec(start, "spec.toml"));
  const std::string rate = "[scene.acquisition]\nframe_rate_hz = { uniform = [25, 60] }\n";
  expectRefused(start + rate, {"spec.toml", "layouts", "myotracker", "30 frames", "may have 23"});
  EXPECT_NO_THROW(parseSpec(start + rate + "beats = 2\n", "spec.toml"));
  expectRefused(start + "[heart]\nhr = { whole = [60, 110] }\n", {"myotracker", "110 beats/min"});
  EXPECT_NO_THROW(parseSpec(start + "[heart]\nhr = { whole = [60, 101] }\n", "spec.toml"));
}

TEST(DatasetSpec, ShardsArePackedFromTheNativeLayout) {
  expectRefused(kStart + "layouts = [\"webdataset\"]\n", {"layouts", "webdataset", "native"});
  expectRefused(kStart + "shard_mb = 100\n", {"spec.toml:3", "shard_mb", "webdataset"});
  const std::string start = kStart + "layouts = [\"native\", \"webdataset\"]\n";
  EXPECT_EQ(parseSpec(start, "spec.toml").shard_mb, 1000);
  expectRefused(start + "shard_mb = 0\n", {"spec.toml:4", "shard_mb", "1 to"});
}

TEST(DatasetSpec, CommentsMakeNoOtherDataset) {
  const Spec plain = parseSpec(kStart, "a.toml"),
             other = parseSpec("# hearts\n" + kStart, "a.toml");
  EXPECT_EQ(plain.digest, other.digest);
  EXPECT_NE(plain.digest, parseSpec("seed = 2\n" + kStart, "a.toml").digest);
}

TEST(DatasetSpec, SplitsAreByHeartAndInOrder) {
  Spec spec = parseSpec("hearts = 500\nviews = [\"a2c\", \"a4c\"]\n", "a.toml");
  EXPECT_EQ(spec.splitOf(399), Split::train);
  EXPECT_EQ(spec.splitOf(400), Split::val);
  EXPECT_EQ(spec.splitOf(449), Split::val);
  EXPECT_EQ(spec.splitOf(450), Split::test);
}

TEST(DatasetSpec, ReadySpecsAreRead) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(support::kSourceDir) / "examples/datasets")) {
    if (entry.path().extension() != ".toml") continue;
    EXPECT_GT(readSpec(entry.path()).loops(), 0u) << entry.path();
    ++count;
  }
  EXPECT_GE(count, 4);
}

}  // namespace
}  // namespace echocine::dataset
