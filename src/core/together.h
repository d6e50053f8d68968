#pragma once
// Two tasks beside each other.

#include <functional>

namespace echocine {

// Runs two bodies, at the same time if a thread of the enclosing withThreads() is free, otherwise
// in this order. Both always run. Then throws the error of the first, else that of the second.
void together(const std::function<void()>& first, const std::function<void()>& second);

}  // namespace echocine
