#include "cli/stop_signal.h"

#include <atomic>
#include <csignal>

namespace echocine {

namespace {

std::atomic<bool> stop_wanted{false};

void noteStop(int) {
  stop_wanted = true;
}

}  // namespace

void listenForStop() {
  std::signal(SIGINT, noteStop);
  std::signal(SIGTERM, noteStop);
}

bool stopWanted() {
  return stop_wanted;
}

}  // namespace echocine
