// Memory that runs out anywhere in a run: one line and exit code 1, or, where a library does
// without, the very bytes; never a crash, never a hang, and finished frames stay whole.

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/faulty_loop.h"

namespace echocine {
namespace {

using namespace support;

class ShortOfMemory : public FaultyLoop {
 protected:
  explicit ShortOfMemory(const SceneText& text = sceneText()) : FaultyLoop(text) {}
  // No DICOM: DCMTK crashes where one of the allocations of its dictionary fails.
  static SceneText sceneText() {
    SceneText text = FaultyLoop::sceneText();
    text.output["dicom"] = "false";
    return text;
  }
  void SetUp() override {
#ifdef ECHOCINE_SANITIZED
    GTEST_SKIP() << "a sanitizer has its own allocator and needs terabytes of addresses";
#endif
  }
  // Returns whether the run failed.
  bool expectOrderlyEnd(const Outcome& outcome) const {
    // toml++ reads numbers by a stream, which takes want of memory for a number it cannot read.
    if (outcome.code == 2 && outcome.err.find("not TOML: Error while parsing") != std::string::npos)
      return true;
    EXPECT_TRUE(outcome.code == 0 || outcome.code == 1) << outcome.code << ' ' << outcome.err;
    if (outcome.code == 0) {
      EXPECT_EQ(outcome.err, "");
      expectSame(leftIn(out), files);
      return false;
    }
    expectOneLine(outcome, 1);
    EXPECT_TRUE(outcome.err.find("emory") != std::string::npos ||
                outcome.err.find("pthread_create has failed") != std::string::npos)
        << outcome.err;
    expectOnlyWholeFiles(out, files);
    return true;
  }
  // One allocation fails, all others succeed: at seeded places, as many early as late ones.
  void failOneAllocation(int runs) const {
    ASSERT_GT(steps.memory, 1000);
    std::mt19937 random(8);
    if (const char* wanted = std::getenv("ECHOCINE_ALLOCATIONS")) runs = std::atoi(wanted);
    const auto most = static_cast<double>(steps.memory);
    int failed = 0;
    for (int i = 0; i < runs; ++i) {
      const double share = (i + std::uniform_real_distribution<double>()(random)) / runs;
      const long step = std::lround(i % 2 ? std::pow(most, share) : std::max(1.0, share * most));
      SCOPED_TRACE(step);
      failed += expectOrderlyEnd(disturbed("memory:" + std::to_string(step), 1 + i % 3 % 2));
    }
    EXPECT_GT(failed, runs / 3);
  }
};

// The other tracer and the other codec.
class ShortOfMemoryWithRefraction : public ShortOfMemory {
 protected:
  ShortOfMemoryWithRefraction() : ShortOfMemory(text()) {}
  static SceneText text() {
    SceneText text = sceneText();
    text.effects["refraction"] = "\"on\"";
    text.output["codec"] = "\"ffv1\"";
    return text;
  }
};

TEST_F(ShortOfMemory, OneAllocationThatFailsEndsInOneLine) {
  failOneAllocation(40);
}

TEST_F(ShortOfMemoryWithRefraction, OneAllocationThatFailsEndsInOneLine) {
  failOneAllocation(30);
}

// From some allocation on, none of 4 KiB or more succeeds; the rest of the run must cope.
TEST_F(ShortOfMemory, AShortageThatLastsEndsInOneLine) {
  std::mt19937 random(9);
  for (int i = 0; i < 16; ++i) {
    const long step = std::uniform_int_distribution<long>(1, steps.memory)(random);
    SCOPED_TRACE(step);
    expectOrderlyEnd(disturbed("shortage:" + std::to_string(step), 1 + i % 2));
    if (i % 4 == 0) expectResumes();
  }
}

// A limit on the address space, from the least that lets the program start to what a run needs.
// Below that the program cannot have its stack of 64 MiB, or the system's loader refuses (exit code
// 127). ECHOCINE_LIMITS sets how many more limits are drawn.
TEST_F(ShortOfMemory, EveryLimitOfAddressesEndsInOneLine) {
  const auto limited = [](std::vector<std::string> arguments, long megabytes) {
    FaultyRun run{std::move(arguments)};
    run.before = [megabytes] {
      const rlimit limit{static_cast<rlim_t>(megabytes) << 20, static_cast<rlim_t>(megabytes)
                                                                   << 20};
      ::setrlimit(RLIMIT_AS, &limit);
    };
    return outcomeOf(run);
  };
  long refused = 0, starts = 4096;
  while (starts - refused > 1) {
    const long middle = (starts + refused) / 2;
    (limited({"--version"}, middle).code == 0 ? starts : refused) = middle;
  }
  constexpr long kStack = 64;
  int without_stack = 0;
  for (long megabytes = starts - kStack + 8; megabytes < starts; megabytes += 8) {
    SCOPED_TRACE(megabytes);
    fs::remove_all(out);
    const Outcome outcome = limited(rendering(out, {}, 4).arguments, megabytes);
    if (outcome.code == 127) continue;
    EXPECT_TRUE(expectOrderlyEnd(outcome));
    ++without_stack;
  }
  EXPECT_GT(without_stack, 0);
  int failed = 0, run_at_all = 0;
  for (long megabytes = starts + 2; run_at_all < 3 && megabytes < starts + 2000;
       megabytes += 1 + (megabytes - starts) / 6) {
    SCOPED_TRACE(megabytes);
    fs::remove_all(out);
    const bool short_of = expectOrderlyEnd(limited(rendering(out, {}, 4).arguments, megabytes));
    failed += short_of;
    run_at_all += !short_of;
  }
  EXPECT_GT(failed, 0);
  EXPECT_EQ(run_at_all, 3);
  expectResumes();
  const char* const wanted = std::getenv("ECHOCINE_LIMITS");
  const int more = wanted ? std::atoi(wanted) : 0;
  std::mt19937 random(10);
  int refused_more = 0;
  for (int i = 0; i < more; ++i) {
    const long megabytes = starts + std::uniform_int_distribution<long>(2, 400)(random);
    SCOPED_TRACE(megabytes);
    fs::remove_all(out);
    refused_more += expectOrderlyEnd(limited(rendering(out, {}, 4).arguments, megabytes));
  }
  if (more > 0) std::printf("%d of %d limits failed, from %ld MB\n", refused_more, more, starts);
}

}  // namespace
}  // namespace echocine
