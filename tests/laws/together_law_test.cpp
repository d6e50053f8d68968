// Two tasks beside each other: both run, and errors and stops are those of one after the other.

#include "core/together.h"

#include <gtest/gtest.h>

#include <atomic>
#include <barrier>
#include <stdexcept>
#include <string>

#include "core/parallel.h"
#include "core/stop.h"

namespace echocine {
namespace {

TEST(TogetherLaw, OneThreadRunsTheFirstThenTheSecond) {
  std::string order;
  withThreads(1, [&] { together([&] { order += "first "; }, [&] { order += "second"; }); });
  EXPECT_EQ(order, "first second");
}

// Each waits for the other: one after the other they would never end.
TEST(TogetherLaw, TwoThreadsRunBothAtTheSameTime) {
  std::barrier both(2);
  int met = 0;
  withThreads(2, [&] {
    together(
        [&] {
          both.arrive_and_wait();
          ++met;
        },
        [&] { both.arrive_and_wait(); });
  });
  EXPECT_EQ(met, 1);
}

TEST(TogetherLaw, LoopsInsideAreComplete) {
  for (const int threads : {1, 2, 4}) {
    std::atomic<int> a = 0, b = 0;
    withThreads(threads, [&] {
      together([&] { parallelBlocks(100, 1, [&](std::size_t, std::size_t) { ++a; }); },
               [&] { parallelBlocks(50, 1, [&](std::size_t, std::size_t) { ++b; }); });
    });
    EXPECT_EQ(a, 100);
    EXPECT_EQ(b, 50);
  }
}

TEST(TogetherLaw, TheFirstErrorWinsAndTheOtherTaskStillRuns) {
  for (const int threads : {1, 2})
    for (int i = 0; i < 20; ++i) {
      std::string message;
      bool second_ran = false;
      try {
        withThreads(threads, [&] {
          together([] { throw std::runtime_error("first"); },
                   [&] {
                     second_ran = true;
                     throw std::runtime_error("second");
                   });
        });
      } catch (const std::runtime_error& error) {
        message = error.what();
      }
      EXPECT_EQ(message, "first");
      EXPECT_TRUE(second_ran);
    }
}

// Each task sees the stop at its own checkpoints; one without any is not cut off.
TEST(TogetherLaw, AStopReachesTheCheckpointsOfBothAndSkipsNeither) {
  for (const int threads : {1, 2}) {
    std::atomic<bool> stop = false;
    std::atomic<int> stopped = 0;
    bool ran = false;
    const auto poll = [&] {
      try {
        checkpoint();
      } catch (const Stopped&) {
        ++stopped;
      }
    };
    stoppable([&] { return stop.load(); },
              [&] {
                withThreads(threads, [&] {
                  together(
                      [&] {
                        stop = true;
                        poll();
                      },
                      [&] {
                        ran = true;
                        while (!stop) {
                        }
                        poll();
                      });
                });
              });
    EXPECT_TRUE(ran);
    EXPECT_EQ(stopped, 2);
  }
}

}  // namespace
}  // namespace echocine
