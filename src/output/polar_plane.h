#pragma once
// From lines to rows, as a file has them.

#include <cstdint>
#include <span>

namespace echocine {

// Turns a line-major plane into rows of equal depth: out[sample * lines + line], bit patterns kept.
// Precondition: in and out hold lines * samples values.
void rowsFromLines(std::span<const float> in, std::size_t lines, std::size_t samples,
                   std::uint32_t* out);
void rowsFromLines(std::span<const std::uint32_t> in, std::size_t lines, std::size_t samples,
                   std::uint32_t* out);

}  // namespace echocine
