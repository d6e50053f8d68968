// The contract of core/parallel.h, whichever threads it was built on.

#include "core/parallel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <mutex>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace echocine {
namespace {

constexpr int kThreadCounts[] = {1, 2, 3, 8};

const auto kAlways = [] { return true; };
const auto kNothing = [](std::size_t) -> std::shared_ptr<void> { return nullptr; };

// The largest number of calls that were under way at once.
class Peak {
 public:
  void enter() {
    const int now = ++inside_;
    int seen = peak_;
    while (now > seen && !peak_.compare_exchange_weak(seen, now)) {
    }
  }
  void leave() { --inside_; }
  int value() const { return peak_; }

 private:
  std::atomic<int> inside_ = 0, peak_ = 0;
};

std::vector<std::pair<std::size_t, std::size_t>> blocksOf(std::size_t count, std::size_t grain,
                                                          int threads) {
  std::mutex mutex;
  std::vector<std::pair<std::size_t, std::size_t>> blocks;
  withThreads(threads, [&] {
    parallelBlocks(count, grain, [&](std::size_t begin, std::size_t end) {
      const std::lock_guard lock(mutex);
      blocks.emplace_back(begin, end);
    });
  });
  std::sort(blocks.begin(), blocks.end());
  return blocks;
}

// Blocks must not depend on threads, for sums over blocks would round differently.
TEST(ParallelLaw, BlocksCoverTheRangeOnceAndAreTheSameForAnyThreadCount) {
  for (const std::size_t count : {0u, 1u, 7u, 8u, 1000u})
    for (const std::size_t grain : {1u, 3u, 8u, 5000u}) {
      const auto one = blocksOf(count, grain, 1);
      EXPECT_EQ(one.size(), (count + grain - 1) / grain);
      std::size_t next = 0;
      for (const auto& [begin, end] : one) {
        EXPECT_EQ(begin, next);
        EXPECT_EQ(end, std::min(begin + grain, count));
        next = end;
      }
      EXPECT_EQ(next, count);
      for (const int threads : kThreadCounts) EXPECT_EQ(blocksOf(count, grain, threads), one);
    }
}

TEST(ParallelLaw, ThreadCountIsWhatWasAskedForAndIsGivenBack) {
  EXPECT_GE(threadCount(), 1);
  withThreads(0, [] { EXPECT_GE(threadCount(), 1); });
  withThreads(3, [] {
    EXPECT_EQ(threadCount(), 3);
    withThreads(2, [] { EXPECT_EQ(threadCount(), 2); });
    EXPECT_EQ(threadCount(), 3);
  });
}

TEST(ParallelLaw, NoMoreThreadsThanAllowedWorkAtOnceAndOneMeansTheCaller) {
  for (const int threads : kThreadCounts) {
    Peak peak;
    std::mutex mutex;
    std::set<std::thread::id> ids;
    withThreads(threads, [&] {
      parallelBlocks(500, 1, [&](std::size_t, std::size_t) {
        peak.enter();
        const std::lock_guard lock(mutex);
        ids.insert(std::this_thread::get_id());
        peak.leave();
      });
    });
    EXPECT_LE(peak.value(), threads);
    if (threads == 1) {
      EXPECT_EQ(ids, std::set{std::this_thread::get_id()});
    }
  }
}

// Every block waits for a second one: a loop that used one thread would never end.
TEST(ParallelLaw, TwoThreadsDoWorkAtOnce) {
  std::barrier meeting(2);
  withThreads(2, [&] {
    parallelBlocks(2, 1, [&](std::size_t, std::size_t) { meeting.arrive_and_wait(); });
  });
  std::barrier again(2);
  withThreads(2, [&] {
    parallelOrdered(
        0, 2, 2, kAlways,
        [&](std::size_t) -> std::shared_ptr<void> {
          again.arrive_and_wait();
          return nullptr;
        },
        [](std::size_t, std::shared_ptr<void>) {});
  });
}

// Frames are made in any order and written in theirs: a cine is a stream.
TEST(ParallelLaw, DrainsEveryResultInOrderOneAtATime) {
  for (const int threads : kThreadCounts)
    for (const std::size_t in_flight : {1u, 2u, 5u, 1000u}) {
      std::vector<std::size_t> drained;
      Peak drains;
      withThreads(threads, [&] {
        const std::size_t end = parallelOrdered(
            10, 210, in_flight, kAlways,
            [](std::size_t i) -> std::shared_ptr<void> { return std::make_shared<std::size_t>(i); },
            [&](std::size_t i, std::shared_ptr<void> result) {
              drains.enter();
              EXPECT_EQ(*static_cast<std::size_t*>(result.get()), i);
              drained.push_back(i);
              drains.leave();
            });
        EXPECT_EQ(end, 210u);
      });
      std::vector<std::size_t> expected(200);
      std::iota(expected.begin(), expected.end(), std::size_t{10});
      EXPECT_EQ(drained, expected);
      EXPECT_EQ(drains.value(), 1);
    }
}

TEST(ParallelLaw, AnEmptyRangeAsksAndCallsNothing) {
  const auto never = [](auto...) -> std::shared_ptr<void> { throw std::logic_error("called"); };
  for (const int threads : kThreadCounts)
    withThreads(threads, [&] {
      EXPECT_EQ(parallelOrdered(4, 4, 3, kAlways, never,
                                [](std::size_t, std::shared_ptr<void>) { FAIL(); }),
                4u);
    });
}

// Bounds the memory of a run whatever its length.
TEST(ParallelLaw, NoMoreResultsAreAliveThanAllowed) {
  struct Counted {
    explicit Counted(Peak& p) : peak(p) { peak.enter(); }
    ~Counted() { peak.leave(); }
    Peak& peak;
  };
  for (const int threads : kThreadCounts)
    for (const std::size_t in_flight : {1u, 2u, 4u}) {
      Peak alive;
      withThreads(threads, [&] {
        parallelOrdered(
            0, 300, in_flight, kAlways,
            [&](std::size_t) -> std::shared_ptr<void> { return std::make_shared<Counted>(alive); },
            [](std::size_t, std::shared_ptr<void>) {});
      });
      EXPECT_LE(alive.value(), static_cast<int>(in_flight));
    }
}

// Ctrl-C: no frame begins, and those begun reach the cine.
TEST(ParallelLaw, ANoStopsTheLoopAndDrainsWhatWasBegun) {
  for (const int threads : kThreadCounts)
    for (const int yes : {0, 1, 5, 40}) {
      std::atomic<int> asked = 0, worked = 0;
      std::size_t drained = 0;
      withThreads(threads, [&] {
        const std::size_t end = parallelOrdered(
            100, 200, 4, [&] { return asked++ < yes; },
            [&](std::size_t i) {
              ++worked;
              return kNothing(i);
            },
            [&](std::size_t, std::shared_ptr<void>) { ++drained; });
        EXPECT_EQ(end, 100u + static_cast<std::size_t>(yes));
      });
      EXPECT_EQ(worked, yes);
      EXPECT_EQ(drained, static_cast<std::size_t>(yes));
      EXPECT_EQ(asked, yes + 1) << "after a no it is not asked again";
    }
}

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
