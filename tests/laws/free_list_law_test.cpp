// Working memory is lent to one user at a time, used again, and made no more often than needed.

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

#include "core/free_list.h"
#include "core/parallel.h"

namespace echocine {
namespace {

struct Space {
  std::atomic<int> users{0};
  int uses = 0;
};

TEST(FreeListLaw, WhatReturnsIsLentAgainAsItWasLeft) {
  FreeList<Space> list;
  int made = 0;
  const auto make = [&] {
    ++made;
    return std::make_unique<Space>();
  };
  const Space* first = nullptr;
  {
    const auto a = list.borrow(make), b = list.borrow(make);
    EXPECT_NE(a, b);
    a->uses = 7;
    first = a.get();
    const auto copy = a;
  }
  EXPECT_EQ(made, 2);
  const auto a = list.borrow(make), b = list.borrow(make);
  EXPECT_TRUE(a.get() == first || b.get() == first);
  EXPECT_EQ(a->uses + b->uses, 7);
  EXPECT_EQ(made, 2);
}

TEST(FreeListLaw, ThreadsNeverShareAnObject) {
  FreeList<Space> list;
  std::atomic<int> made{0}, shared{0}, uses{0};
  withThreads(8, [&] {
    parallelBlocks(20'000, 1, [&](std::size_t, std::size_t) {
      const auto space = list.borrow([&] {
        ++made;
        return std::make_unique<Space>();
      });
      if (space->users++ != 0) ++shared;
      ++space->uses;
      ++uses;
      --space->users;
    });
    EXPECT_EQ(shared, 0);
    EXPECT_EQ(uses, 20'000);
    EXPECT_LE(made, threadCount());
  });
}

TEST(FreeListLaw, AFailedMakeLendsNothing) {
  FreeList<Space> list;
  EXPECT_THROW(list.borrow([]() -> std::unique_ptr<Space> { throw std::runtime_error("full"); }),
               std::runtime_error);
  EXPECT_NE(list.borrow([] { return std::make_unique<Space>(); }), nullptr);
}

}  // namespace
}  // namespace echocine
