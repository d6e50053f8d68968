#include "cli/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <string>

#include "cli/standard_error.h"

namespace echocine {

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1) {}

void ProgressLine::show(const Progress& progress) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  if (progress.pass != pass_) {
    pass_ = progress.pass;
    pass_start_ = last_told_;
  }
  last_told_ = now;
  // A bar ten times a second; lines every ten seconds, for logs.
  const auto pause = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10000);
  const bool last = progress.done == progress.total;
  if (now - last_shown_ < pause && !last) return;
  last_shown_ = now;
  const double elapsed_s = std::chrono::duration<double>(now - pass_start_).count();
  const double per_second = elapsed_s > 0 ? progress.done / elapsed_s : 0;
  const double left_s = per_second > 0 ? (progress.total - progress.done) / per_second : 0;
  const char* doing = pass_ == Progress::Pass::measuring ? "measuring" : "rendering";
  const std::string numbers = fmt::format(
      "{} {}/{} frames, {:.1f} frames/s, {}:{:02} left", doing, progress.done, progress.total,
      per_second, static_cast<int>(left_s) / 60, static_cast<int>(left_s) % 60);
  if (!terminal_) {
    writeError(numbers + "\n");
    return;
  }
  constexpr int kWidth = 30;
  const int full = kWidth * progress.done / progress.total;
  writeError(fmt::format("\r[{:#<{}}{:-<{}}] {}\x1b[K", "", full, "", kWidth - full, numbers));
  open_ = true;
}

void ProgressLine::finish() {
  if (open_) writeError("\n");
  open_ = false;
}

}  // namespace echocine
