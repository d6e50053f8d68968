#pragma once
// Time spent in the stages of a run.

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

#include "core/stage.h"

namespace echocine {

// Time spent in each stage, summed over threads.
class StageClock {
 public:
  template <typename F>
  auto time(Stage stage, F&& work) {
    const Timer timer(ns_[static_cast<std::size_t>(stage)]);
    return work();
  }
  std::array<double, kStages> milliseconds() const;

 private:
  struct Timer {
    explicit Timer(std::atomic<std::int64_t>& ns) : sum(ns) {}
    ~Timer() { sum += (std::chrono::steady_clock::now() - start).count(); }
    std::atomic<std::int64_t>& sum;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  };
  std::array<std::atomic<std::int64_t>, kStages> ns_{};
};

}  // namespace echocine
