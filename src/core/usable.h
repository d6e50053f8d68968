#pragma once
#include <cstddef>
#include <optional>
#include <span>

namespace echocine {

// Position of the first value that is invalid as intensity, attenuation or grey level: negative,
// infinite or NaN. Negative zero is valid.
std::optional<std::size_t> firstUnusable(std::span<const float> values);

}  // namespace echocine
