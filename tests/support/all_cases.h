#pragma once
// Long sweeps: a normal run takes only some of their cases, because each takes seconds.

#include <cstddef>
#include <cstdlib>
#include <vector>

namespace echocine::support {

// Set ECHOCINE_ALL_CASES to take every case.
inline bool allCases() {
  return std::getenv("ECHOCINE_ALL_CASES") != nullptr;
}

// The first `few` cases, or all.
template <typename T>
std::vector<T> casesOf(std::vector<T> all, std::size_t few) {
  if (!allCases() && few < all.size())
    all.erase(all.begin() + static_cast<std::ptrdiff_t>(few), all.end());
  return all;
}

}  // namespace echocine::support
