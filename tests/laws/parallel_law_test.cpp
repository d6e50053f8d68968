// The contract of core/parallel.h, whichever threads it was built on.

#include "core/parallel.h"
#include "support/ordered_loops.h"

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

using namespace support;

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

}  // namespace
}  // namespace echocine
