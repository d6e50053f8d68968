// Work in a child process with limits: answers, and every way to end without one.

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <thread>

#include "core/error.h"
#include "core/limited_child.h"
#include "core/stop.h"

namespace echocine {
namespace {

std::span<const std::byte> bytesOfText(const std::string& text) {
  return std::as_bytes(std::span(text));
}

ChildLimits briefLimits() {
  ChildLimits limits;
  limits.cpu_s = 1;
  limits.memory_bytes = std::size_t{256} << 20;
  limits.answer_bytes = std::size_t{8} << 20;
  return limits;
}

bool hasChildren() {
  return ::waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD;
}

TEST(LimitedChild, GivesItsAnswer) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{5} << 20}) {
    const std::string text(size, 'x');
    const ChildAnswer answer =
        runInChild(briefLimits(), [&](const ChildWriter& write) { write(bytesOfText(text)); });
    EXPECT_EQ(answer.end, ChildEnd::done);
    ASSERT_EQ(answer.bytes.size(), size);
    EXPECT_EQ(std::memcmp(answer.bytes.data(), text.data(), size), 0);
  }
  EXPECT_FALSE(hasChildren());
}

TEST(LimitedChild, EndsOfAllKindsAreTold) {
  const auto endOfChild = [](const std::function<void(const ChildWriter&)>& act,
                             const ChildLimits& limits = briefLimits()) {
    return runInChild(limits, act).end;
  };
  const std::string text(100, 'x');
  EXPECT_EQ(endOfChild([&](const ChildWriter& write) {
              write(bytesOfText(text));
              ::raise(SIGSEGV);
            }),
            ChildEnd::crashed);
  EXPECT_EQ(endOfChild([](const ChildWriter&) { std::abort(); }), ChildEnd::crashed);
  EXPECT_EQ(endOfChild([](const ChildWriter&) { ::_exit(0); }), ChildEnd::crashed);
  EXPECT_EQ(endOfChild([](const ChildWriter&) { throw SceneError("no"); }), ChildEnd::crashed);
  EXPECT_EQ(endOfChild([](const ChildWriter&) {
              volatile unsigned n = 0;
              for (;;) n = n + 1;
            }),
            ChildEnd::out_of_time);
  EXPECT_EQ(endOfChild([&](const ChildWriter& write) {
              const std::string piece(1 << 20, 'x');
              for (;;) write(bytesOfText(piece));
            }),
            ChildEnd::too_long);
#ifndef ECHOCINE_SANITIZED  // a sanitizer ends the process instead of throwing
  ChildLimits patient = briefLimits();
  patient.cpu_s = 20;  // new pages of 256 MB may take more than a second
  EXPECT_EQ(endOfChild(
                [](const ChildWriter&) {
                  std::vector<std::vector<char>> all;
                  for (;;) all.emplace_back(std::size_t{16} << 20);
                },
                patient),
            ChildEnd::out_of_memory);
#endif
  EXPECT_FALSE(hasChildren());
}

TEST(LimitedChild, AStopEndsTheChild) {
  EXPECT_THROW(stoppable([] { return true; },
                         [] { runInChild(briefLimits(), [](const ChildWriter&) { ::pause(); }); }),
               Stopped);
  int asked = 0;
  EXPECT_THROW(stoppable([&] { return ++asked > 3; },
                         [] { runInChild(briefLimits(), [](const ChildWriter&) { ::pause(); }); }),
               Stopped);
  EXPECT_FALSE(hasChildren());
}

// A host that ignores its children's ends, and many threads that ask at once.
TEST(LimitedChild, WorksInAnyHost) {
  const auto before = ::signal(SIGCHLD, SIG_IGN);
  const std::string text = "answer";
  const auto ask = [&] {
    const ChildAnswer answer =
        runInChild(briefLimits(), [&](const ChildWriter& write) { write(bytesOfText(text)); });
    EXPECT_EQ(answer.end, ChildEnd::done);
    EXPECT_EQ(answer.bytes.size(), text.size());
  };
  ask();
  EXPECT_EQ(runInChild(briefLimits(), [](const ChildWriter&) { ::raise(SIGSEGV); }).end,
            ChildEnd::crashed);
  ::signal(SIGCHLD, before);
#ifndef ECHOCINE_SANITIZED  // the race detector follows no fork of a process with threads
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] {
      for (int n = 0; n < 10; ++n) ask();
    });
  for (std::thread& thread : threads) thread.join();
#endif
  EXPECT_FALSE(hasChildren());
}

}  // namespace
}  // namespace echocine
