#pragma once
// The simulator object of Python.

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
  const std::uint64_t number = next();  // unique in the process; frames store it
  std::mutex mutex;
  std::vector<std::unique_ptr<Frame>> scratch;

 private:
  static std::uint64_t next() {
    static std::atomic<std::uint64_t> made{0};
    return ++made;
  }
};

}  // namespace echocine::python
