// Loops of core/parallel.h that throw, that stand in one another, and that two callers run at once.

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <numeric>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/parallel.h"
#include "support/ordered_loops.h"

namespace echocine {
namespace {

using namespace support;

// What the loop throws, and that nothing of it runs on after it has thrown.
template <typename Loop>
std::string thrownBy(int threads, const Loop& loop) {
  std::string what;
  withThreads(threads, [&] {
    try {
      loop();
    } catch (const std::runtime_error& error) {
      what = error.what();
    }
    int more = 0;  // the threads are there for the next loop
    parallelOrdered(0, 20, 2, kAlways, kNothing,
                    [&](std::size_t, std::shared_ptr<void>) { ++more; });
    EXPECT_EQ(more, 20);
  });
  return what;
}

// And nothing of the loop runs on after the caller has caught it.
TEST(ParallelLaw, AnExceptionOfAnyFunctionEndsTheLoopAndReachesTheCaller) {
  for (const int threads : kThreadCounts) {
    std::atomic<int> calls = 0;
    EXPECT_EQ(thrownBy(threads,
                       [&] {
                         parallelBlocks(1'000'000, 1, [&](std::size_t begin, std::size_t) {
                           ++calls;
                           if (begin == 3) throw std::runtime_error("block");
                         });
                       }),
              "block");
    EXPECT_LT(calls, 1'000'000);

    std::size_t drained = 0;
    const auto count = [&](std::size_t, std::shared_ptr<void>) { ++drained; };
    EXPECT_EQ(thrownBy(threads,
                       [&] {
                         parallelOrdered(
                             0, 1000, 4, kAlways,
                             [](std::size_t i) -> std::shared_ptr<void> {
                               if (i == 7) throw std::runtime_error("work");
                               return nullptr;
                             },
                             count);
                       }),
              "work");
    EXPECT_LE(drained, 7u) << "nothing after the one that failed is drained";

    EXPECT_EQ(thrownBy(threads,
                       [&] {
                         parallelOrdered(0, 1000, 4, kAlways, kNothing,
                                         [](std::size_t i, std::shared_ptr<void>) {
                                           if (i == 5) throw std::runtime_error("drain");
                                         });
                       }),
              "drain");
    EXPECT_EQ(thrownBy(threads,
                       [&] {
                         parallelOrdered(
                             0, 1000, 4, []() -> bool { throw std::runtime_error("asked"); },
                             kNothing, count);
                       }),
              "asked");
  }
}

// A waiting thread that took another frame up would enter its own scratch memory twice.
// A thread that waits for its inner loop may be given other work; another frame would need memory
// that nobody counted.
TEST(ParallelLaw, AFrameThatWaitsForItsLinesTakesUpNoOtherFrame) {
  for (const int threads : kThreadCounts) {
    std::atomic<int> entered_twice = 0;
    std::vector<std::size_t> sums;
    withThreads(threads, [&] {
      parallelOrdered(
          0, 60, 8, kAlways,
          [&](std::size_t frame) -> std::shared_ptr<void> {
            thread_local int frames_here = 0;
            if (++frames_here > 1) ++entered_twice;
            std::vector<std::size_t> lines(64);
            parallelBlocks(lines.size(), 4, [&](std::size_t begin, std::size_t end) {
              for (std::size_t i = begin; i < end; ++i) lines[i] = frame * i;
            });
            isolated([&] {
              parallelBlocks(lines.size(), 16, [&](std::size_t begin, std::size_t end) {
                for (std::size_t i = begin; i < end; ++i) lines[i] += 1;
              });
            });
            --frames_here;
            return std::make_shared<std::size_t>(
                std::accumulate(lines.begin(), lines.end(), std::size_t{0}));
          },
          [&](std::size_t, std::shared_ptr<void> sum) {
            sums.push_back(*static_cast<std::size_t*>(sum.get()));
          });
    });
    EXPECT_EQ(entered_twice, 0);
    ASSERT_EQ(sums.size(), 60u);
    for (std::size_t frame = 0; frame < sums.size(); ++frame)
      EXPECT_EQ(sums[frame], frame * (63 * 64 / 2) + 64);
  }
}

// Nobody is left waiting for a loop that has thrown.
TEST(ParallelLaw, AnExceptionWithinANestedLoopPassesThroughTheOuterOne) {
  for (const int threads : kThreadCounts)
    EXPECT_EQ(thrownBy(threads,
                       [&] {
                         parallelOrdered(
                             0, 100, 4, kAlways,
                             [](std::size_t frame) -> std::shared_ptr<void> {
                               parallelBlocks(32, 1, [&](std::size_t line, std::size_t) {
                                 if (frame == 9 && line == 17) throw std::runtime_error("line 17");
                               });
                               return nullptr;
                             },
                             [](std::size_t, std::shared_ptr<void>) {});
                       }),
              "line 17");
}

// What comes after a loop takes its work for done: a frame's own loop ends whole although another
// frame fails meanwhile.
TEST(ParallelLaw, AFrameThatFailsLeavesTheLoopsOfOthersWhole) {
  constexpr int kLines = 64;
  std::atomic<bool> begun = false, failed = false;
  std::atomic<int> lines = 0, ended = 0;
  withThreads(2, [&] {
    EXPECT_THROW(parallelOrdered(
                     0, 2, 2, kAlways,
                     [&](std::size_t frame) -> std::shared_ptr<void> {
                       const auto until = [](const std::atomic<bool>& what) {
                         for (int i = 0; i < 2000 && !what; ++i)
                           std::this_thread::sleep_for(std::chrono::milliseconds(1));
                       };
                       if (frame == 0) {
                         until(begun);
                         failed = true;
                         throw std::runtime_error("frame 0");
                       }
                       parallelBlocks(kLines, 1, [&](std::size_t line, std::size_t) {
                         begun = true;
                         if (line == 0) until(failed);
                         std::this_thread::sleep_for(std::chrono::milliseconds(1));
                         ++lines;
                       });
                       ++ended;
                       return nullptr;
                     },
                     [](std::size_t, std::shared_ptr<void>) {}),
                 std::runtime_error);
  });
  if (ended == 1) {
    EXPECT_EQ(lines, kLines);
  }
}

// A library's callers bring threads of their own.
TEST(ParallelLaw, TwoCallersAtOnceDoNotMeet) {
  std::vector<std::size_t> sums(2);
  const auto caller = [&](std::size_t which) {
    withThreads(2, [&] {
      for (int round = 0; round < 50; ++round)
        parallelOrdered(0, 10, 4, kAlways, kNothing,
                        [&](std::size_t i, std::shared_ptr<void>) { sums[which] += i; });
    });
  };
  std::thread other(caller, std::size_t{1});
  caller(0);
  other.join();
  EXPECT_EQ(sums, (std::vector<std::size_t>{50 * 45, 50 * 45}));
}

}  // namespace
}  // namespace echocine
