#include "cli/stop_signal.h"

#include <time.h>

#include <atomic>
#include <csignal>

namespace echocine {

namespace {

// Lock-free, so it may be written from a signal handler.
std::atomic<long> first_wish_s{0};  // 0: none yet

// Monotonic seconds, from 1: 0 is taken. clock_gettime() is safe in a handler.
long now_s() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec + 1;
}

// Programs that pass signals on may send one twice at once, so only a wish that comes clearly after
// the first is the user's second.
void noteStop(int signal) {
  constexpr long kSecondWish_s = 2;  // our choice
  long first = 0;
  const long now = now_s();
  if (first_wish_s.compare_exchange_strong(first, now) || now - first < kSecondWish_s) return;
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

// Who is started by nohup keeps running when the terminal goes.
void listenForStop() {
  std::signal(SIGINT, noteStop);
  std::signal(SIGTERM, noteStop);
  if (std::signal(SIGHUP, noteStop) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // nohup
}

bool stopWanted() {
  return first_wish_s != 0;
}

}  // namespace echocine
