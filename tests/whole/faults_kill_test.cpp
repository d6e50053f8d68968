// Whenever a run is killed, going on gives the bytes of a run that nothing disturbed.

#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <random>

#include "support/all_cases.h"
#include "support/faulty_loop.h"

namespace echocine {
namespace {

using namespace support;

class KilledLoop : public FaultyLoop {};

// Between two calls that change files the folder does not change, so these are all the states that
// a kill can leave of this loop: before each call, and after half of each write. A normal run takes
// every third.
TEST_F(KilledLoop, AtEveryChangeOfAFileResumesToTheSameBytes) {
  ASSERT_GT(steps.files, 30);
#ifdef ECHOCINE_SANITIZED
  const long every = 7;  // a start takes seconds
#else
  const long every = allCases() ? 1 : 3;
#endif
  for (long step = 1; step <= steps.files; step += every) {
    SCOPED_TRACE(step);
    EXPECT_EQ(disturbed("half:" + std::to_string(step)).code, 128 + SIGKILL);
    expectOnlyWholeFiles(out, files);
    expectResumes();
  }
}

// A run over a finished loop of the same scene takes its files away first: killed on the way, it
// leaves no mix that going on would take for whole.
TEST_F(KilledLoop, OverAnEarlierLoopResumesToTheSameBytes) {
  fs::copy(undisturbed, out, fs::copy_options::recursive);
  FaultyRun run = rendering(out);
  Steps again;
  ASSERT_EQ(outcomeOf(run, &again).code, 0);
  std::mt19937 random(5);
  for (int i = 0; i < 8; ++i) {
    const long step = std::uniform_int_distribution<long>(1, again.files)(random);
    SCOPED_TRACE(step);
    run.fault = "kill:" + std::to_string(step);
    EXPECT_EQ(outcomeOf(run).code, 128 + SIGKILL);
    expectResumes();
  }
}

// A run that goes on is killed as well.
TEST_F(KilledLoop, WhileResumingResumesToTheSameBytes) {
  std::mt19937 random(6);
  for (int i = 0; i < 8; ++i) {
    const auto draw = [&](long most) {
      return std::uniform_int_distribution<long>(1, most)(random);
    };
    const long first = draw(steps.files), second = draw(20);
    SCOPED_TRACE(testing::Message() << first << " and " << second);
    EXPECT_EQ(disturbed("kill:" + std::to_string(first)).code, 128 + SIGKILL);
    FaultyRun run = rendering(out, {"--resume"});
    run.fault = "half:" + std::to_string(second);
    EXPECT_EQ(outcomeOf(run).code, 128 + SIGKILL);
    expectOnlyWholeFiles(out, files);
    expectResumes();
  }
}

// By kill -9 from outside at seeded moments between the start and the end, two threads.
// ECHOCINE_KILLS sets how many.
TEST_F(KilledLoop, AtSeededMomentsResumesToTheSameBytes) {
  const char* wanted = std::getenv("ECHOCINE_KILLS");
  const int kills = wanted ? std::atoi(wanted) : 12;
  const auto start = std::chrono::steady_clock::now();
  ASSERT_EQ(outcomeOf(rendering(out, {}, 2)).code, 0);
  const std::chrono::duration<double> whole_run = std::chrono::steady_clock::now() - start;
  std::mt19937 random(7);
  int killed = 0;
  for (int i = 0; killed < kills && i < 4 * kills; ++i) {  // some moments come after the end
    SCOPED_TRACE(i);
    fs::remove_all(out);
    FaultyRun run = rendering(out, {}, 2);
    const double share = (i % kills + std::uniform_real_distribution<double>()(random)) / kills;
    run.meanwhile = [&](pid_t child) {
      const double wait_s = share * whole_run.count();
      const timespec wait{static_cast<time_t>(wait_s),
                          static_cast<long>(1e9 * (wait_s - std::floor(wait_s)))};
      ::nanosleep(&wait, nullptr);
      ::kill(child, SIGKILL);
    };
    const int code = outcomeOf(run).code;
    EXPECT_TRUE(code == 128 + SIGKILL || code == 0) << code;
    killed += code != 0;
    expectOnlyWholeFiles(out, files);
    expectResumes();
  }
  RecordProperty("killed", killed);
  std::printf("%d runs were killed before their end and resumed\n", killed);
}

// A study has times, so its bytes differ from run to run: what bears a file's name is whole, and
// the same command in the same folder then leaves the same names and rows. ECHOCINE_KILLS sets how
// many.
TEST_F(KilledLoop, AStudyLeavesWholeFilesAndRunsAgain) {
  const FaultyRun study{{"study", scene, "-o", out, "--frames", "1", "--repeats", "1", "--knobs",
                         "lines", "--quiet", "--threads", "1"}};
  const auto wholeFiles = [&] {
    std::map<std::string, std::string> found = leftIn(out);
    for (auto& [name, bytes] : found) {
      if (isPart(name)) continue;
      EXPECT_TRUE(!name.ends_with(".json") || nlohmann::json::accept(bytes)) << name;
      EXPECT_TRUE(!name.ends_with(".html") || bytes.ends_with("</html>\n")) << name;
      EXPECT_TRUE(!name.ends_with(".csv") || bytes.ends_with("\n")) << name;
      const auto lines = std::count(bytes.begin(), bytes.end(), '\n');
      bytes = name.ends_with(".csv") ? std::to_string(lines) + " lines" : "";
    }
    return found;
  };
  Steps all;
  ASSERT_EQ(outcomeOf(study, &all).code, 0);
  const auto whole = wholeFiles();
  ASSERT_TRUE(whole.contains("study.json") && whole.contains("study.csv"));
  const char* wanted = std::getenv("ECHOCINE_KILLS");
  const int kills = wanted ? std::atoi(wanted) : 3;
  std::mt19937 random(15);
  for (int i = 0; i < kills; ++i) {
    fs::remove_all(out);
    FaultyRun run = study;
    run.fault = "half:" + std::to_string(std::uniform_int_distribution<long>(1, all.files)(random));
    SCOPED_TRACE(run.fault);
    EXPECT_EQ(outcomeOf(run).code, 128 + SIGKILL);
    for (const auto& [name, lines] : wholeFiles()) {  // rows stand as they come
      if (isPart(name)) continue;
      EXPECT_LE(std::atoi(lines.c_str()), std::atoi(whole.at(name).c_str())) << name;
    }
    EXPECT_EQ(outcomeOf(study).code, 0);
    EXPECT_EQ(wholeFiles(), whole);
  }
}

}  // namespace
}  // namespace echocine
