#include "cli/progress_line.h"

#include <fmt/format.h>

#include <string>

namespace echocine {

ProgressLine::ProgressLine(bool quiet) : bar_(quiet) {}

void ProgressLine::show(const Progress& progress) {
  const Clock::time_point now = Clock::now();
  if (progress.pass != pass_) {
    pass_ = progress.pass;
    pass_start_ = last_told_;
  }
  last_told_ = now;
  const auto done = static_cast<std::size_t>(progress.done),
             total = static_cast<std::size_t>(progress.total);
  if (!bar_.due(done, total)) return;
  const double elapsed_s = std::chrono::duration<double>(now - pass_start_).count();
  const double per_second = elapsed_s > 0 ? progress.done / elapsed_s : 0;
  const double left_s = per_second > 0 ? (progress.total - progress.done) / per_second : 0;
  const char* doing = pass_ == Progress::Pass::measuring ? "measuring the loop's reference," : "rendering";
  bar_.draw(done, total,
            fmt::format("{} {}/{} frames, {:.1f} frames/s, {} left", doing, progress.done,
                        progress.total, per_second, minutesAndSeconds(left_s)));
}

void ProgressLine::finish() {
  bar_.finish();
}

}  // namespace echocine
