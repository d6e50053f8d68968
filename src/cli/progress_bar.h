#pragma once
// A bar that is redrawn on a terminal; periodic lines otherwise.

#include <chrono>
#include <string>

namespace echocine {

// On standard error, so that piped output stays clean.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet);
  // Ten times a second on a terminal; every ten seconds otherwise; always at the end.
  bool due(std::size_t done, std::size_t total);
  void draw(std::size_t done, std::size_t total, const std::string& text);
  void finish();  // ends an open bar

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_, terminal_, open_ = false;
  Clock::time_point last_shown_{};
};

// Seconds as "3:07".
std::string minutesAndSeconds(double seconds);

}  // namespace echocine
