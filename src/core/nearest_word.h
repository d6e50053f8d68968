#pragma once
// What a misspelt word was meant to be.

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace echocine {

// The candidate with the fewest edits to `word`; empty when none is nearer than `edits`, half the
// word or three letters if left out.
std::string nearestWord(std::string_view word, const std::vector<std::string>& candidates,
                        std::optional<std::size_t> edits = std::nullopt);

}  // namespace echocine
