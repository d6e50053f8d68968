#pragma once
// Message for std::bad_alloc, a failed job.

namespace echocine {

inline constexpr const char* kOutOfMemory =
    "out of memory: fewer lines, samples, subdivision levels or threads need less";

}  // namespace echocine
