// Drawn loops whose texture is known: of the same law they are not distinguishable, of another
// grain they are.

#include "dataset/real_loops.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/hash_random.h"
#include "core/parallel.h"
#include "support/run_files.h"
#include "support/run_program.h"

namespace echocine::dataset {
namespace {

using support::TempFolder;

constexpr int kSide = 160, kFrames = 30;
constexpr double kPixel_mm = 0.5;

// A sector of blocks of `grain` pixels with independent grey levels around 90. `outside` is the
// grey level of a text beside the sector.
GreyImage drawn(int seed, int frame, int grain, int outside) {
  GreyImage image{kSide, kSide, {}};
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double across = x + 0.5 - kSide / 2.0, down = y + 0.5;
      const bool inside = std::abs(across) < 0.7 * down && std::hypot(across, down) < 150;
      const double noise = normalFromHashes(hashOf(seed, frame, x / grain, y / grain, 0),
                                            hashOf(seed, frame, x / grain, y / grain, 1));
      const bool text = outside > 0 && x > 4 && x < 24 && y > 6 && y < 12;
      image.pixels.push_back(static_cast<std::uint8_t>(inside
                                                           ? std::clamp(90 + 25 * noise, 1.0, 255.0)
                                                       : text ? outside
                                                              : 0));
    }
  return image;
}

class RealLoops : public testing::Test {
 protected:
  void SetUp() override {
    Sink sink(folder.path());
    for (int heart = 1; heart <= 6; ++heart) {
      const std::string id = "ec00000" + std::to_string(heart) + "_a4c";
      draw("native/" + id + "/cine.avi", heart, 3);
      records.push_back(
          {{"heart", heart}, {"loops", Json::array({{{"id", id}, {"mm_per_pixel", kPixel_mm}}})}});
    }
  }
  RealLoop draw(const std::string& name, int seed, int grain, int outside = 0) {
    std::vector<GreyImage> images;
    std::vector<const GreyImage*> frames;
    for (int f = 0; f < kFrames; ++f) images.push_back(drawn(seed, f, grain, outside));
    for (const GreyImage& image : images) frames.push_back(&image);
    Sink(folder.path()).writeCine(name, frames, 30);
    return {folder / name, kPixel_mm};
  }
  RealComparison compare(const std::vector<RealLoop>& real) const {
    RealComparison made;
    withThreads(1, [&] { made = compareWithReal(folder.path(), records, real, {}); });
    return made;
  }
  void expectRefused(const std::vector<RealLoop>& real, const std::string& words) const {
    try {
      compare(real);
      ADD_FAILURE() << words;
    } catch (const SceneError& refusal) {
      EXPECT_NE(std::string(refusal.what()).find(words), std::string::npos) << refusal.what();
    }
  }

  TempFolder folder;
  std::vector<Json> records;
};

TEST_F(RealLoops, OfTheSameLawAreNotDistinguishable) {
  const RealComparison same = compare({draw("a.avi", 11, 3), draw("b.avi", 12, 3)});
  EXPECT_EQ(same.hearts, 6u);
  EXPECT_EQ(same.frames, 60u);
  ASSERT_EQ(same.loops.size(), 2u);
  // 30 frames against 10: the area of equal distributions has a standard deviation of 0.11.
  for (const RealComparison::Loop& loop : same.loops) {
    EXPECT_EQ(loop.frames, 10u);
    EXPECT_NEAR(loop.area, 0.5, 0.33);
  }
}

TEST_F(RealLoops, OfAnotherGrainAreRecognised) {
  const RealComparison coarse = compare({draw("a.avi", 11, 5), draw("b.avi", 12, 5)});
  for (const RealComparison::Loop& loop : coarse.loops) EXPECT_EQ(loop.area, 1);
  ASSERT_EQ(coarse.strongest.size(), 2u);
  for (const RealComparison::Weight& one : coarse.strongest) EXPECT_NE(one.simulated, one.real);
  // One fine and one coarse loop: each is foreign to a classifier that knows the other.
  const RealComparison mixed = compare({draw("c.avi", 13, 2), draw("d.avi", 14, 5)});
  for (const RealComparison::Loop& loop : mixed.loops) EXPECT_LT(loop.area, 0.5);
}

// Pixels outside the sector do not affect the comparison.
TEST_F(RealLoops, PixelsOutsideTheSectorDoNotCount) {
  const RealComparison plain = compare({draw("a.avi", 11, 3), draw("b.avi", 12, 3)});
  const RealComparison text = compare({draw("c.avi", 11, 3, 250), draw("d.avi", 12, 3, 250)});
  for (const std::size_t i : {0u, 1u})
    EXPECT_NEAR(text.loops[i].area, plain.loops[i].area, 0.15) << i;
}

TEST_F(RealLoops, TheCardStatesLoopsAndMeanWithoutFileNames) {
  RealComparison made;
  made.hearts = 4;
  made.frames = 80;
  made.loops = {{10, 0.75}, {20, 1}};
  made.strongest = {{"localStd", 2, 7, 9}};
  const std::string text = realLoopsText(made);
  for (const char* words : {"| 1 | 10 | 0.750 |", "| 2 | 20 | 1.000 |", "mean of 2 loops | | 0.875",
                            "80 frames of 4 hearts", "`localStd` (simulated 7, real 9)"})
    EXPECT_NE(text.find(words), std::string::npos) << words << '\n' << text;
  EXPECT_NE(realLoopsText({}).find("no real loops were given"), std::string::npos);
  EXPECT_EQ(realLoopsJson(made)["loops"][0]["auc"], 0.75);
}

TEST_F(RealLoops, WhatCannotBeComparedIsRefused) {
  const RealLoop one = draw("a.avi", 11, 3);
  expectRefused({one}, "one loop, accepted: two or more");
  expectRefused({one, {folder / "absent.avi", 1}}, "absent.avi");
  expectRefused({one, {folder / "a.avi", 10}}, "sector is too small");
  records.resize(1);
  expectRefused({one, one}, "fewer than two hearts");
}

// The merge writes the section, and one without real loops removes it.
TEST_F(RealLoops, AreAddedToTheCardByAMerge) {
  const std::string rest = support::bytesOf(std::filesystem::path(support::kSourceDir) /
                                            "tests/support/small_loops.toml");
  const auto spec =
      folder.write("own.toml", "hearts = 2\nviews = [\"a4c\"]\nlayouts = [\"native\"]\n" + rest);
  const std::string make = "%B dataset '" + spec.string() + "' -o '" + (folder / "own").string() +
                           "' --quiet --threads 2 ";
  ASSERT_EQ(support::runShell(make).code, 0);
  const auto plain = support::filesOf(folder / "own");
  EXPECT_NE(plain.at("README.md").find("no real loops were given"), std::string::npos);
  const RealLoop a = draw("a.avi", 11, 3), b = draw("b.avi", 12, 3);
  const std::string both = "'" + a.file.string() + "=0.5' '" + b.file.string() + "=0.5'";
  const support::Outcome merged = support::runShell(make + "--merge --real " + both);
  ASSERT_EQ(merged.code, 0) << merged.err;
  const auto compared = support::filesOf(folder / "own");
  EXPECT_NE(compared.at("README.md").find("| mean of 2 loops |"), std::string::npos);
  EXPECT_EQ(compared.at("README.md").find("a.avi"), std::string::npos);
  EXPECT_EQ(Json::parse(compared.at("dataset.json"))["real_loops"]["loops"].size(), 2u);
  for (const char* words : {"a.avi", "=1", "a.avi=0", "a.avi=1x"}) {
    const support::Outcome refused =
        support::runShell(make + "--merge --real " + both + " " + words);
    EXPECT_EQ(refused.code, 2) << words;
    EXPECT_NE(refused.err.find("accepted: FILE=MM"), std::string::npos) << refused.err;
  }
  EXPECT_EQ(support::runShell(make + "--real " + both).code, 2);  // without --merge
  ASSERT_EQ(support::runShell(make + "--merge").code, 0);
  EXPECT_EQ(support::filesOf(folder / "own"), plain);
}

}  // namespace
}  // namespace echocine::dataset
