#pragma once
// A simulator as Python holds it.

#include <memory>
#include <mutex>
#include <vector>

#include "simulate/simulator.h"

namespace echocine::python {

struct NativeSimulator {
  explicit NativeSimulator(const Scene& scene) : simulator(scene) {}
  const Simulator simulator;
  std::mutex mutex;
  std::vector<std::unique_ptr<Frame>> scratch;
};

}  // namespace echocine::python
