#pragma once
// What tests of parallel loops run them with.

#include <cstddef>
#include <memory>

namespace echocine::support {

inline constexpr int kThreadCounts[] = {1, 2, 3, 8};

// A loop that is never stopped, and results of no interest.
inline constexpr auto kAlways = [] { return true; };
inline constexpr auto kNothing = [](std::size_t) -> std::shared_ptr<void> { return nullptr; };

}  // namespace echocine::support
