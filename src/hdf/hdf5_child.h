#pragma once
// The part of readHdf5() that calls the library, in the child process.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "core/limited_child.h"
#include "hdf/hdf5_input.h"

namespace echocine {

// The kind of an answer, and what follows it: nothing, shape and values, a text, the reason.
enum class Hdf5Sign : std::uint8_t { absent, bytes, floats, text, refused };

inline constexpr std::size_t kMostHdf5Rank = 8, kMostHdf5Reason = 400;

// Writes the answers in the order of the queries. A refusal ends them.
void answerHdf5(const std::filesystem::path& file, std::span<const Hdf5Query> queries,
                const ChildWriter& write);

}  // namespace echocine
