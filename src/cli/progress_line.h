#pragma once
// How far a run is: a bar that redraws itself on a terminal, a line now and then elsewhere.

#include <chrono>

#include "cli/progress_bar.h"
#include "render/render.h"

namespace echocine {

class ProgressLine {
 public:
  explicit ProgressLine(bool quiet);
  void show(const Progress& progress);  // from one thread at a time
  void finish();                        // ends an open bar

 private:
  using Clock = std::chrono::steady_clock;
  ProgressBar bar_;
  Progress::Pass pass_ = Progress::Pass::measuring;
  Clock::time_point pass_start_ = Clock::now(), last_told_ = Clock::now();
};

}  // namespace echocine
