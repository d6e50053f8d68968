#pragma once
// What to say of std::bad_alloc, which is a failed job.

namespace echocine {

inline constexpr const char* kOutOfMemory =
    "out of memory: fewer lines, samples, subdivision levels or threads need less";

}  // namespace echocine
