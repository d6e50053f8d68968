#pragma once
// OpenMesh has process-wide state: its message streams are created on first use, and its readers
// are singletons. Only one thread at a time may use it.

#include <mutex>

namespace echocine {

// Locks the library for the lifetime of the result and silences its messages. Not recursive.
[[nodiscard]] std::unique_lock<std::mutex> takeOpenMesh();

}  // namespace echocine
