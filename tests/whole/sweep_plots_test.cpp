// sweep_plots: what the tests recorded of hard cases becomes plots; anything else is
// refused by its line.

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "support/run_program.h"
#include "support/temp_folder.h"
#include "tests/hard/plot/sweep_files.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

const std::string kHead =
    "# case: critical angle: R\n# against: long double\n# variable: cos_i / cos_c - 1\n"
    "# bound: 1e-05\nat,got,expected,error\n";

class StudySweeps : public ::testing::Test {
 protected:
  fs::path put(const std::string& name, const std::string& text) {
    fs::create_directories(folder / "sweeps");
    return folder.write("sweeps/" + name, text);
  }
  Outcome plot() {
    return runShell(kSweepPlots + (" '" + (folder / "sweeps").string()) + "' '" +
                    (folder / "out").string() + "'");
  }
  TempFolder folder;
};

TEST_F(StudySweeps, AreReadByNameAndInTheOrderOfTheirVariable) {
  put("b.csv", kHead + "0.25,1,1,0\n-1e-16,nan,1,inf\n0,2,1,1\n");
  put("a.csv", kHead + "1,1,1,2e-8\r\n");
  put("other.txt", "no sweep");
  const std::vector<HardCaseSweep> sweeps = readSweeps(folder / "sweeps");
  ASSERT_EQ(sweeps.size(), 2u);
  EXPECT_EQ(sweeps[0].file, "a.csv");
  EXPECT_EQ(sweeps[0].worst().error, 2e-8);
  const HardCaseSweep& b = sweeps[1];
  EXPECT_EQ(b.name, "critical angle: R");
  EXPECT_EQ(b.oracle, "long double");
  EXPECT_EQ(b.variable, "cos_i / cos_c - 1");
  EXPECT_EQ(b.bound, 1e-5);
  ASSERT_EQ(b.points.size(), 3u);
  EXPECT_EQ(b.points[0].at, -1e-16);
  EXPECT_EQ(b.points[2].at, 0.25);
  EXPECT_TRUE(std::isinf(b.worst().error));
}

TEST(SweepPoints, AreThinnedWithoutLosingASpike) {
  std::vector<SweepPoint> points;
  for (int i = 0; i < 10007; ++i) points.push_back({static_cast<double>(i), 1e-17});
  for (const std::size_t spike : {0u, 1u, 5000u, 10006u}) {
    points[spike].error = 1;
    const std::vector<SweepPoint> kept = thinned(points, 100);
    ASSERT_EQ(kept.size(), 100u);
    EXPECT_EQ(std::count_if(kept.begin(), kept.end(),
                            [&](const SweepPoint& p) {
                              return p.error == 1 && p.at == static_cast<double>(spike);
                            }),
              1);
    for (std::size_t i = 1; i < kept.size(); ++i) EXPECT_LT(kept[i - 1].at, kept[i].at);
    points[spike].error = 1e-17;
  }
  EXPECT_EQ(thinned(points, 20000).size(), points.size());
}

TEST_F(StudySweeps, BecomeOnePage) {
  put("a.csv", kHead + "1,1,1,2e-8\n");
  const Outcome outcome = plot();
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string page = bytesOf(folder / "out/sweeps.html");
  EXPECT_NE(page.find("critical angle: R"), std::string::npos);
  EXPECT_NE(page.find("[1.0,2e-08]"), std::string::npos);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out"), {}), 1);
}

// The sweeps of the tests themselves, as they record them.
TEST_F(StudySweeps, OfTheTestsAreReadAndWithinTheirBounds) {
  const Outcome recorded = runShell("ECHOCINE_HARD_CASES='" + (folder / "sweeps.md").string() +
                                    "' '" + fs::read_symlink("/proc/self/exe").string() +
                                    "' --gtest_filter='ScatteringSweep*:InterfaceSweep*'");
  ASSERT_EQ(recorded.code, 0) << recorded.out;
  const std::vector<HardCaseSweep> sweeps = readSweeps(folder / "sweeps");
  EXPECT_EQ(sweeps.size(), 22u);
  for (const HardCaseSweep& sweep : sweeps) {
    EXPECT_LE(sweep.worst().error, sweep.bound) << sweep.name;
    EXPECT_GT(sweep.points.size(), 100u) << sweep.name;
  }
  EXPECT_EQ(plot().code, 0);
}

TEST_F(StudySweeps, ThatAreNoneAreRefusedByFileAndLine) {
  const auto swapped = [](const std::string& from, const std::string& to) {
    std::string text = kHead + "1,1,1,0\n";
    return text.replace(text.find(from), from.size(), to);
  };
  const std::pair<std::string, std::string> bad[] = {
      {"", ":1: is no line \"# case: ...\""},
      {"at,got,expected,error\n1,1,1,0\n", ":1: is no line \"# case: ...\""},
      {swapped("# case: critical angle: R", "# case: "), ":1: "},
      {swapped("# variable", "# bound"), ":3: is no line \"# variable: ...\""},
      {swapped("1e-05", "small"), ":4: \"small\" is no number"},
      {swapped("1e-05", "-1"), ":4: a bound is 0 or more"},
      {swapped("1e-05", "inf"), ":4: a bound is 0 or more"},
      {swapped("at,got", "x,got"), ":5: is not the columns' names, at,got,expected,error"},
      {kHead, ":6: there is no point"},
      {kHead + "1,1,1,0\n1,1,1\n", ":7: is no row of four numbers"},
      {kHead + "1,1,1,0,0\n", ":6: is no row of four numbers"},
      {kHead + "1,1,1,0\n\n", ":7: is no row of four numbers"},
      {kHead + "1,1,one,0\n", ":6: \"one\" is no number"},
      {kHead + "1,1,1,0 \n", ":6: \"0 \" is no number"},
      {kHead + "1,1,1,-1e-9\n", ":6: an error is 0 or more"},
      {kHead + "1,1,1,nan\n", ":6: an error is 0 or more"},
      {kHead + "inf,1,1,0\n", ":6: \"at\" is not finite"}};
  put("a.csv", kHead + "1,1,1,0\n");
  for (const auto& [text, said] : bad) {
    const fs::path file = put("b.csv", text);
    const Outcome outcome = plot();
    EXPECT_EQ(outcome.code, 2) << said;
    EXPECT_NE(outcome.err.find(file.string() + said), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_FALSE(fs::exists(folder / "out"));
  }
}

TEST_F(StudySweeps, NeedAFolderOfThem) {
  for (const char* arguments : {"", "nowhere", "nowhere x", "nowhere x y"}) {
    const Outcome outcome =
        runShell("cd '" + folder.path().string() + "' && " + kSweepPlots + " " + arguments);
    EXPECT_EQ(outcome.code, 2) << arguments;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
  put("note.txt", "");
  EXPECT_NE(plot().err.find("has no sweep"), std::string::npos);
  EXPECT_EQ(plot().code, 2);
  put("a.csv", kHead + "1,1,1,0\n");
  folder.write("out", "");
  EXPECT_EQ(plot().code, 1);
}

}  // namespace
}  // namespace echocine
