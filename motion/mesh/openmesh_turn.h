#pragma once
// OpenMesh keeps state in the process: its message streams are built by their first use, and its
// readers are single objects. One thread at a time may use either.

#include <mutex>

namespace echocine {

// Holds the library for the caller until the lock goes; its messages are silent. Not recursive.
[[nodiscard]] std::unique_lock<std::mutex> takeOpenMesh();

}  // namespace echocine
