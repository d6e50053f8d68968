#pragma once
#include <cstddef>
#include <optional>
#include <span>

namespace echocine {

// Position of the first value that no intensity, attenuation or grey can have: negative, infinite
// or not a number. A negative zero passes.
std::optional<std::size_t> firstUnusable(std::span<const float> values);

}  // namespace echocine
