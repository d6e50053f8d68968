// Wishes to stop, at exact steps and from outside.

#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/stat.h>

#include <random>

#include "support/faulty_loop.h"

namespace echocine {
namespace {

using namespace support;

#ifdef ECHOCINE_SANITIZED
constexpr int kMoments = 4;  // a start takes seconds
#else
constexpr int kMoments = 16;
#endif

long drawStep(std::mt19937& random, long most) {
  return std::uniform_int_distribution<long>(1, most)(random);
}

class StoppedLoop : public FaultyLoop {};

// Frames in the making are given up unless they are whole, so a signal during the last frames may
// change nothing.
TEST_F(StoppedLoop, AtSeededStepsLeavesACineOfTheFinishedFrames) {
  std::mt19937 random(10);
  int stopped = 0;
  for (int i = 0; i < kMoments; ++i) {
    const long step = i == 0 ? 1 : drawStep(random, steps.files);
    const std::string signal = std::vector<std::string>{"int", "term", "hup"}[i % 3];
    SCOPED_TRACE(signal + " at " + std::to_string(step));
    const Outcome outcome = disturbed(signal + ":" + std::to_string(step), 1 + i % 2);
    for (const auto& file : leftIn(out)) EXPECT_FALSE(isPart(file.first)) << file.first;
    expectOnlyWholeFiles(out, files);
    if (outcome.code == 0) {
      expectSame(leftIn(out), files);
      continue;
    }
    ++stopped;
    expectOneLine(outcome, 1);
    EXPECT_NE(outcome.err.find("stopped: "), std::string::npos) << outcome.err;
    EXPECT_FALSE(fs::exists(out / "manifest.json"));
    const auto frames = fs::exists(out / "intensity")
                            ? std::distance(fs::directory_iterator(out / "intensity"), {})
                            : 0;
    // Of frames that are made at once a later one may be whole, which going on takes.
    EXPECT_LE(std::max(cineFrames(out / "cine.avi"), 0), frames);
    expectResumes();
  }
  EXPECT_GT(stopped, 0);
}

// Going on over a loop whose cine is longer, and stopped at once: the longer cine stays.
TEST_F(StoppedLoop, AResumedRunThatIsStoppedKeepsTheLongerCine) {
  fs::copy(undisturbed, out, fs::copy_options::recursive);
  FaultyRun run = rendering(out, {"--resume"});
  Steps again;
  ASSERT_EQ(outcomeOf(run, &again).code, 0);
  const std::string cine = bytesOf(out / "cine.avi");
  std::mt19937 random(11);
  for (int i = 0; i < 5; ++i) {
    run.fault = "int:" + std::to_string(drawStep(random, again.files));
    SCOPED_TRACE(run.fault);
    const Outcome outcome = outcomeOf(run);
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 1) << outcome.err;
    EXPECT_TRUE(bytesOf(out / "cine.avi") == cine);
  }
}

TEST_F(StoppedLoop, APlanLeavesNothingInTheFolderOfTemporaryFiles) {
  const fs::path temporary = folder / "tmp";
  fs::create_directory(temporary);
  FaultyRun run{{"plan", scene, "--quiet"}};
  run.before = [&temporary] { ::setenv("TMPDIR", temporary.c_str(), 1); };
  Steps plan;
  ASSERT_EQ(outcomeOf(run, &plan).code, 0);
  std::mt19937 random(12);
  int stopped = 0;
  for (int i = 0; i < kMoments / 2; ++i) {
    run.fault =
        std::string(i % 2 ? "int:" : "term:") + std::to_string(drawStep(random, plan.files));
    SCOPED_TRACE(run.fault);
    const Outcome outcome = outcomeOf(run);
    EXPECT_TRUE(fs::is_empty(temporary));
    if (outcome.code == 0) continue;
    ++stopped;
    expectOneLine(outcome, 1);
    EXPECT_NE(outcome.err.find("stopped"), std::string::npos) << outcome.err;
  }
  EXPECT_GT(stopped, 0);
}

// One frame of thousands of rays a beam takes minutes: it is given up.
TEST_F(StoppedLoop, AFrameThatTakesLongIsGivenUp) {
  SceneText text = sceneText(1);
  text.probe["lines"] = "1024";
  text.probe["samples"] = "4096";
  text.accuracy["rays_per_beam"] = "4096";
  writeBall(folder, text);
  FaultyRun run{{"render", scene, "-o", out, "--quiet", "--threads", "1"}};
  run.meanwhile = [&](pid_t child) {
    while (!fs::exists(out / "intensity"))  // made just before the first frame
      if (hasEnded(child)) return;
    ::usleep(400000);  // the frame has begun
    ::kill(child, SIGINT);
  };
  const Outcome outcome = outcomeOf(run);
  expectOneLine(outcome, 1);
  EXPECT_NE(outcome.err.find("stopped: "), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(out / "manifest.json"));
  EXPECT_TRUE(fs::is_empty(out / "intensity"));
}

// A call of the system that does not return has no checkpoint; the second wish does not wait.
TEST_F(StoppedLoop, ASecondSignalEndsAtOnce) {
  FaultyRun run = rendering(out);
  run.fault = "hang:" + std::to_string(steps.files / 2);
  int signals = 0;
  run.meanwhile = [&](pid_t child) {
    for (int idle = 0; idle < 10; ::usleep(50000)) {  // until it hangs
      if (hasEnded(child)) return;
      const double before_s = usedBy_s(child);
      ::usleep(50000);
      idle = before_s > 0 && usedBy_s(child) == before_s ? idle + 1 : 0;
    }
    for (; !hasEnded(child); ++signals) {  // until two signals lie two seconds apart
      ::kill(child, SIGINT);
      ::usleep(100000);
    }
  };
  EXPECT_EQ(outcomeOf(run).code, 128 + SIGINT);
  EXPECT_GE(signals, 2);
  EXPECT_FALSE(fs::exists(out / "manifest.json"));
}

class StoppedHeart : public ::testing::Test {
 protected:
  FaultyRun heart() const {
    return {{"heart", "-o", folder / "heart", "--quiet", "--keyframes", "4", "--threads", "1"}};
  }
  TempFolder folder;
};

TEST_F(StoppedHeart, LeavesNothing) {
  FaultyRun run = heart();
  Steps steps;
  ASSERT_EQ(outcomeOf(run, &steps).code, 0);
  std::mt19937 random(13);
  for (int i = 0; i < 4; ++i) {
    fs::remove_all(folder / "heart");
    run.fault = std::vector<std::string>{"int:", "term:", "hup:"}[i % 3] +
                std::to_string(drawStep(random, steps.files / 2));  // later, a run may end first
    SCOPED_TRACE(run.fault);
    const Outcome outcome = outcomeOf(run);
    expectOneLine(outcome, 1);
    EXPECT_NE(outcome.err.find("stopped"), std::string::npos) << outcome.err;
    EXPECT_TRUE(fs::is_empty(folder.path()));
  }
}

// What a killed run leaves stands beside, and the next run takes it away.
TEST_F(StoppedHeart, KilledLeavesNoFolderOfTheNameAndTheNextRunIsWhole) {
  FaultyRun run = heart();
  Steps steps;
  ASSERT_EQ(outcomeOf(run, &steps).code, 0);
  const auto whole = leftIn(folder / "heart");
  fs::remove_all(folder / "heart");
  std::mt19937 random(14);
  for (int i = 0; i < 4; ++i) {
    run.fault = "half:" + std::to_string(i == 0 ? steps.files : drawStep(random, steps.files));
    SCOPED_TRACE(run.fault);
    EXPECT_EQ(outcomeOf(run).code, 128 + SIGKILL);
    EXPECT_FALSE(fs::exists(folder / "heart"));
  }
  folder.write("heart.echocine-part/stale.obj", "left by a killed run");
  run.fault.clear();
  EXPECT_EQ(outcomeOf(run).code, 0);
  expectSame(leftIn(folder / "heart"), whole);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1);
}

}  // namespace
}  // namespace echocine
