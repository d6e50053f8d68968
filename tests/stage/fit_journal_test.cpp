// Evaluations that a fit keeps: read back to the bit, up to the first damaged one.

#include <gtest/gtest.h>

#include <fstream>

#include "core/digest.h"
#include "core/error.h"
#include "fit/fit_journal.h"
#include "support/run_program.h"
#include "support/temp_folder.h"

namespace echocine::fit {
namespace {

using namespace support;

std::string fitOf(char c) {
  return std::string(Digest::kDigits, c);
}

PoseFound poseOf(double number) {
  PoseFound out;
  out.pose = {number, 0.5 * number, 0.1, 1.01, 3, 0.4};
  out.terms = {0.5, 0.4, 0.3, 0.9};
  out.discrepancy = 0.1 + number;
  out.rivals = {{FitPose{0.01, 0, 0, 1}, 0.6}, {FitPose{}, 0.7}};
  out.confidence = 0.25;
  out.at_limit = true;
  return out;
}

std::string keyOf(int i) {
  return FitJournal::keyOf("starts", 0, {0.1 * i}, {}, nullptr);
}

void expectSame(const PoseFound& a, const PoseFound& b) {
  EXPECT_EQ(a.pose.shift_x_m, b.pose.shift_x_m);
  EXPECT_EQ(a.pose.lag, b.pose.lag);
  EXPECT_EQ(a.pose.systole, b.pose.systole);
  EXPECT_EQ(a.terms.overlap, b.terms.overlap);
  EXPECT_EQ(a.discrepancy, b.discrepancy);
  EXPECT_EQ(a.confidence, b.confidence);
  EXPECT_EQ(a.at_limit, b.at_limit);
  ASSERT_EQ(a.rivals.size(), b.rivals.size());
  EXPECT_EQ(a.rivals[0].first.shift_x_m, b.rivals[0].first.shift_x_m);
  EXPECT_EQ(a.rivals[1].second, b.rivals[1].second);
}

void fill(const std::filesystem::path& file, int records) {
  FitJournal journal(file, fitOf('a'));
  for (int i = 0; i < records; ++i) journal.add(keyOf(i), poseOf(1e-3 * i));
}

TEST(FitJournal, RecordsAreReadAsTheyWereWritten) {
  TempFolder folder;
  const auto file = folder / "fit/fit.journal";
  {
    const FitJournal empty(file, fitOf('a'));
    EXPECT_FALSE(std::filesystem::exists(folder / "fit"));  // without a record no file
  }
  fill(file, 5);
  FitJournal again(file, fitOf('a'));
  EXPECT_EQ(again.size(), 5u);
  for (int i = 0; i < 5; ++i) {
    const auto found = again.find(keyOf(i));
    ASSERT_TRUE(found) << i;
    expectSame(*found, poseOf(1e-3 * i));
  }
  EXPECT_FALSE(again.find(keyOf(5)));
  again.add(keyOf(5), poseOf(5));
  EXPECT_TRUE(again.find(keyOf(5)));
  again.finish();
  EXPECT_FALSE(std::filesystem::exists(file));
  again.add(keyOf(6), poseOf(6));
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(FitJournal, KeysDifferInEachPart) {
  const FitPose pose{0.001, 0, 0, 1};
  const std::vector<std::string> keys{FitJournal::keyOf("a", 0, {1, 2}, {}, nullptr),
                                      FitJournal::keyOf("b", 0, {1, 2}, {}, nullptr),
                                      FitJournal::keyOf("a", 1, {1, 2}, {}, nullptr),
                                      FitJournal::keyOf("a", 0, {1, 3}, {}, nullptr),
                                      FitJournal::keyOf("a", 0, {1, 2}, {0.1, 0}, nullptr),
                                      FitJournal::keyOf("a", 0, {1, 2}, {}, &pose)};
  EXPECT_EQ(std::set<std::string>(keys.begin(), keys.end()).size(), keys.size());
}

// Cut anywhere or changed: records before it are kept, later ones are written after them.
TEST(FitJournal, DamageEndsTheFile) {
  TempFolder folder;
  const auto file = folder / "fit.journal";
  fill(file, 4);
  const std::string whole = bytesOf(file);
  std::size_t most = 0;
  for (std::size_t cut = 0; cut < whole.size(); cut += 37) {
    std::ofstream(file, std::ios::binary) << whole.substr(0, cut);
    FitJournal journal(file, fitOf('a'));
    EXPECT_LE(most, journal.size());
    most = journal.size();
    for (int i = 0; i < 4; ++i) journal.add(keyOf(i), poseOf(1e-3 * i));
    EXPECT_EQ(bytesOf(file).size(), whole.size()) << cut;
  }
  EXPECT_EQ(most, 3u);
  std::string changed = whole;
  changed[whole.size() / 2] = static_cast<char>(changed[whole.size() / 2] ^ 4);
  std::ofstream(file, std::ios::binary) << changed;
  EXPECT_LT(FitJournal(file, fitOf('a')).size(), 4u);
}

TEST(FitJournal, AnotherFitAndAnotherRunAreRefusedInOneLine) {
  TempFolder folder;
  const auto file = folder / "fit.journal";
  fill(file, 2);
  try {
    const FitJournal other(file, fitOf('b'));
    ADD_FAILURE();
  } catch (const SceneError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("fit.journal: is of a fit of other loops"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos);
  }
  const FitJournal held(file, fitOf('a'));
  EXPECT_THROW(FitJournal(file, fitOf('a')), JobError);
}

}  // namespace
}  // namespace echocine::fit
