#pragma once
// Transposes lines to the rows of a file.

#include <cstdint>
#include <span>
#include <vector>

namespace echocine {

// Converts a line-major plane to rows of equal depth: out[sample * lines + line], with unchanged
// bit patterns. Precondition: in and out hold lines * samples values.
void rowsFromLines(std::span<const float> in, std::size_t lines, std::size_t samples,
                   std::uint32_t* out);
void rowsFromLines(std::span<const std::uint32_t> in, std::size_t lines, std::size_t samples,
                   std::uint32_t* out);

// The rows themselves.
std::vector<float> rowsFromLines(std::span<const float> in, std::size_t lines, std::size_t samples);

}  // namespace echocine
