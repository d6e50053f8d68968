#pragma once
// Work on bytes that may crash a library, in a process of its own with limits.

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace echocine {

struct ChildLimits {
  double cpu_s = 10;  // CPU time, rounded up to whole seconds
  // Address space beyond that of this process at its start.
  std::size_t memory_bytes = std::size_t{1} << 30;
  std::size_t answer_bytes = std::size_t{1} << 30;
};

enum class ChildEnd { done, crashed, out_of_time, out_of_memory, too_long };

struct ChildAnswer {
  ChildEnd end = ChildEnd::crashed;
  std::vector<std::byte> bytes;  // all that the child wrote; complete only if done
};

// Appends to the child's answer.
using ChildWriter = std::function<void(std::span<const std::byte>)>;

// Runs `act` in a fork of this process and returns what it wrote. Whatever happens in the child
// (crash, endless loop, exit, exception) ends there, and no process is left behind. The child ends
// with the calling thread. A stop of the job (core/stop.h) ends the child and throws Stopped.
// Throws JobError if the system has no process or pipe left.
//
// The child has one thread and the locks of its parent as they were. So `act` may allocate memory
// and read files, but must not print, start threads, or use a library that another thread may be
// inside of.
ChildAnswer runInChild(const ChildLimits& limits,
                       const std::function<void(const ChildWriter&)>& act);

}  // namespace echocine
