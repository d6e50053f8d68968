#pragma once
// Progress of a job: a bar that is redrawn on a terminal; periodic lines otherwise.

#include <chrono>

#include "cli/progress_bar.h"
#include "core/monitor.h"

namespace echocine {

class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  void show(const Progress& progress);  // from one thread at a time
  void finish();                        // ends an open bar

  // Shows progress, stops on a signal and prints warnings. Precondition: the line outlives it.
  Monitor monitor();

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  ProgressBar bar_;
  Task task_ = Task::reference;
  Clock::time_point task_start_ = Clock::now(), last_told_ = Clock::now();
};

}  // namespace echocine
