#include "cli/progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include "cli/standard_error.h"

namespace echocine {

ProgressBar::ProgressBar(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

bool ProgressBar::due(std::size_t done, std::size_t total) {
  if (quiet_) return false;
  // Ten a second is as fast as one reads; a log wants a line now and then.
  const auto pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10000);
  const Clock::time_point now = Clock::now();
  if (now - last_shown_ < pause && done != total) return false;
  last_shown_ = now;
  return true;
}

void ProgressBar::draw(std::size_t done, std::size_t total, const std::string& text) {
  if (!terminal_) {
    writeError(text + "\n");
    return;
  }
  constexpr std::size_t kWidth = 30;
  const std::size_t full = total > 0 ? kWidth * done / total : kWidth;
  // Back to the line's start, and the rest of an older, longer line erased.
  writeError(fmt::format("\r[{:#<{}}{:-<{}}] {}\x1b[K", "", full, "", kWidth - full, text));
  open_ = true;
}

void ProgressBar::finish() {
  if (open_) writeError("\n");
  open_ = false;
}

// Hours are shown as minutes above 60, so that long runs are easy to recognise.
std::string minutesAndSeconds(double seconds) {
  const auto whole = static_cast<int>(seconds);
  return fmt::format("{}:{:02}", whole / 60, whole % 60);
}

}  // namespace echocine
