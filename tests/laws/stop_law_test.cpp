// Work that is stopped inside its parts (core/stop.h): the question reaches every thread that
// helps, and nobody else.

#include <gtest/gtest.h>

#include <atomic>
#include <memory>

#include "core/error.h"
#include "core/parallel.h"
#include "core/stop.h"
#include "support/ordered_loops.h"

namespace echocine {
namespace {

using namespace support;

const StopQuestion kStop = [] { return true; };

TEST(StopLaw, ACheckpointThrowsOnlyInsideAndOnlyWhenTheAnswerIsYes) {
  EXPECT_NO_THROW(checkpoint());
  stoppable([] { return false; }, [] { EXPECT_NO_THROW(checkpoint()); });
  EXPECT_THROW(stoppable(kStop, [] { checkpoint(); }), JobError);
  EXPECT_NO_THROW(checkpoint());  // also after it has thrown
}

TEST(StopLaw, TheInnermostQuestionCounts) {
  stoppable(kStop, [] {
    stoppable([] { return false; }, [] { EXPECT_NO_THROW(checkpoint()); });
    EXPECT_THROW(checkpoint(), JobError);
  });
}

TEST(StopLaw, BlocksStopWhileTheLoopRuns) {
  for (const int threads : kThreadCounts) {
    std::atomic<int> begun = 0;
    const auto wanted = [&] { return begun >= 10; };
    EXPECT_THROW(stoppable(wanted,
                           [&] {
                             withThreads(threads, [&] {
                               parallelBlocks(1'000'000, 1,
                                              [&](std::size_t, std::size_t) { ++begun; });
                             });
                           }),
                 JobError);
    EXPECT_LE(begun, 10 + threads);
  }
}

// The loop within an ordered one runs on any of its threads.
TEST(StopLaw, TheQuestionReachesLoopsWithinLoops) {
  for (const int threads : kThreadCounts) {
    std::atomic<int> begun = 0, unasked = 0;
    const auto wanted = [&] { return begun >= 20; };
    const auto work = [&](std::size_t) -> std::shared_ptr<void> {
      inThisThread([&] {
        parallelBlocks(8, 1, [&](std::size_t, std::size_t) {
          ++begun;
          if (stopQuestion() == nullptr) ++unasked;
        });
      });
      return nullptr;
    };
    EXPECT_THROW(stoppable(wanted,
                           [&] {
                             withThreads(threads, [&] {
                               parallelOrdered(0, 100'000, 4, kAlways, work,
                                               [](std::size_t, std::shared_ptr<void>) {});
                             });
                           }),
                 JobError);
    EXPECT_LE(begun, 20 + threads);
    EXPECT_EQ(unasked, 0);
  }
}

TEST(StopLaw, ThreadsForgetTheQuestionOfALoopThatIsOver) {
  for (const int threads : kThreadCounts)
    withThreads(threads, [&] {
      stoppable([] { return false; },
                [] { parallelBlocks(64, 1, [](std::size_t, std::size_t) {}); });
      std::atomic<int> asked = 0;
      parallelBlocks(64, 1, [&](std::size_t, std::size_t) {
        if (stopQuestion() != nullptr) ++asked;
      });
      EXPECT_EQ(asked, 0);
    });
}

}  // namespace
}  // namespace echocine
