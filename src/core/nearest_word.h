#pragma once
// Suggestion for a misspelt word.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace echocine {

// The candidate with the fewest edits to `word`. Empty if none is within `edits`; the default is
// half the word, at most three letters.
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates,
                        std::optional<std::size_t> edits = std::nullopt);

}  // namespace echocine
