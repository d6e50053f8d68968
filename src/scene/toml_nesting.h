#pragma once
// Nesting depth of a TOML text, checked before the library parses it: dotted keys and headers
// become nested tables, which the library processes by recursion.

#include <string_view>

namespace echocine {

// A scene nests four deep: media.NAME.backscatter.KEY. Our choice.
inline constexpr int kMaxTomlNesting = 32;

// Line of the first key with more parts, or of brackets nested deeper; 0: none.
int lineNestedTooDeep(std::string_view text);

}  // namespace echocine
