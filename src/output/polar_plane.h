#pragma once
// What every plane of a polar frame goes through on its way into a file.

#include <cstdint>
#include <optional>
#include <span>

namespace echocine {

// Position of the first value that no intensity, attenuation or grey can have: negative, infinite
// or not a number. A negative zero passes.
std::optional<std::size_t> firstUnusable(std::span<const float> values);

// Turns a line-major plane into rows of equal depth: out[sample * lines + line], bit patterns kept.
// Precondition: in and out hold lines * samples values.
void rowsFromLines(std::span<const float> in, std::size_t lines, std::size_t samples,
                   std::uint32_t* out);
void rowsFromLines(std::span<const std::uint32_t> in, std::size_t lines, std::size_t samples,
                   std::uint32_t* out);

}  // namespace echocine
