#pragma once
// Time spent in the stages of a run.

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace echocine {

// The timed stages, in the manifest's order.
enum class Stage { motion, geometry, trace, speckle, signal, scan_conversion, truth, exr, avi };
inline constexpr std::size_t kStages = 9;

constexpr const char* stageName(Stage stage) {
  constexpr std::array<const char*, kStages> kNames{
      "motion", "geometry", "trace", "speckle", "signal", "scan_conversion", "truth", "exr", "avi"};
  return kNames[static_cast<std::size_t>(stage)];
}

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
