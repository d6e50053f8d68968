#include "core/usable.h"

#include <algorithm>
#include <limits>

namespace echocine {
namespace {

// Comparisons with a value that is not a number are false. `&` in place of `&&` leaves no branch,
// so that the loop over a plane becomes vector instructions.
bool isUsable(float value) {
  return (value >= 0.0f) & (value <= std::numeric_limits<float>::max());
}

}  // namespace

std::optional<std::size_t> firstUnusable(std::span<const float> values) {
  // No early exit: planes are nearly always sound, and a loop without a branch is several times
  // faster.
  int all_usable = 1;
  for (const float value : values) all_usable &= isUsable(value);
  if (all_usable == 1) return std::nullopt;
  const auto first = std::find_if_not(values.begin(), values.end(), isUsable);
  return static_cast<std::size_t>(first - values.begin());
}

}  // namespace echocine
