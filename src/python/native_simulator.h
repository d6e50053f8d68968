#pragma once
// A simulator as Python holds it.

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "frame/simulator.h"

namespace echocine::python {

struct NativeSimulator {
  explicit NativeSimulator(const Scene& scene) : simulator(scene) {}
  const Simulator simulator;
  const std::uint64_t number = next();  // of the process's simulators; frames keep it
  std::mutex mutex;
  std::vector<std::unique_ptr<Frame>> scratch;

 private:
  static std::uint64_t next() {
    static std::atomic<std::uint64_t> made{0};
    return ++made;
  }
};

}  // namespace echocine::python
