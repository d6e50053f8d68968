#pragma once
// Steps of a parallel loop, counted for a monitor.

#include <atomic>
#include <cstddef>
#include <mutex>

#include "core/monitor.h"

namespace echocine::fit {

// Thread-safe. It must not outlive the monitor.
class CountedSteps {
 public:
  CountedSteps(const Monitor& monitor, std::size_t total) : monitor_(monitor), total_(total) {}

  // Before a step: false if the monitor has requested a stop, now or earlier.
  bool next() {
    if (!monitor_.keep_going()) stopped_ = true;
    return !stopped_;
  }
  void done() {
    const std::lock_guard lock(telling_);
    monitor_.tell({Task::settings, ++done_, total_});
  }
  bool stopped() const { return stopped_; }

 private:
  const Monitor& monitor_;
  std::size_t total_, done_ = 0;
  std::mutex telling_;
  std::atomic<bool> stopped_ = false;
};

}  // namespace echocine::fit
