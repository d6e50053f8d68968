#pragma once
// A bar that redraws itself on a terminal, a line now and then elsewhere.

#include <chrono>
#include <string>

namespace echocine {

// On standard error, so that a pipe of the output stays clean.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  // Ten times a second on a terminal; every ten seconds for logs; always at the end.
  bool due(std::size_t done, std::size_t total);
  void draw(std::size_t done, std::size_t total, const std::string& text);
  void finish();  // ends an open bar

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, terminal_, open_ = false;
  Clock::time_point last_shown_{};
};

// "3:07" of seconds.
std::string minutesAndSeconds(double seconds);

}  // namespace echocine
