#pragma once
#include <mutex>

#include "core/work_counts.h"

namespace echocine {

// The work of a simulator's frames. Thread-safe.
class WorkTally {
 public:
  void addFrame(const WorkCounts& work) {
    const std::lock_guard lock(mutex_);
    work_ += work;
    ++frames_;
  }
  WorkCounts work() const {
    const std::lock_guard lock(mutex_);
    return work_;
  }
  int frames() const {
    const std::lock_guard lock(mutex_);
    return frames_;
  }

 private:
  mutable std::mutex mutex_;
  WorkCounts work_;
  int frames_ = 0;
};

}  // namespace echocine
