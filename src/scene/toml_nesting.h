#pragma once
// How deep a TOML text nests, known before the library parses it: dotted keys and headers become
// tables within tables, which it takes apart by recursion.

#include <string_view>

namespace echocine {

// A scene nests four deep: media.NAME.backscatter.KEY. Our choice.
inline constexpr int kMaxTomlNesting = 32;

// The line of the first key of more parts than that, or of brackets within as many others; 0: none.
int lineNestedTooDeep(std::string_view text);

}  // namespace echocine
