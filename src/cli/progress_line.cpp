#include "cli/progress_line.h"

#include <fmt/format.h>

#include "cli/stop_signal.h"
#include "cli/warning_printer.h"

namespace echocine {

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), bar_(quiet) {}

void ProgressLine::show(const Progress& progress) {
  const Clock::time_point now = Clock::now();
  if (progress.task != task_) {
    task_ = progress.task;
    // A task's clock begins where the last one's ended: set-up is nobody's rate.
    task_start_ = last_told_;
  }
  last_told_ = now;
  if (!bar_.due(progress.done, progress.total)) return;
  const TaskWords words = wordsOf(task_);
  if (progress.total == 0)  // how many it will take is not known before
    return bar_.draw(0, 1, fmt::format("{} {} {}", words.doing, progress.done, words.unit));
  const double elapsed_s = std::chrono::duration<double>(now - task_start_).count();
  const double per_second = elapsed_s > 0 ? static_cast<double>(progress.done) / elapsed_s : 0;
  const auto left = static_cast<double>(progress.total - progress.done);
  // The job's own estimate has precedence, because it knows the cost of each setting. A rate of 0
  // gives no estimate.
  const double left_s = progress.seconds_left >= 0 ? progress.seconds_left
                        : per_second > 0           ? left / per_second
                                                   : 0;
  bar_.draw(
      progress.done, progress.total,
      fmt::format("{} {}/{} {}, {:.1f} {}/s, {} left", words.doing, progress.done, progress.total,
                  words.unit, per_second, words.unit, minutesAndSeconds(left_s)));
}

void ProgressLine::finish() {
  bar_.finish();
}

Monitor ProgressLine::monitor() {
  return {.tell = [this](const Progress& progress) { show(progress); },
          .keep_going = [] { return !stopWanted(); },
          .warn = warningPrinter(quiet_)};
}

}  // namespace echocine
