#include "scene/toml_nesting.h"

#include <algorithm>
#include <cstddef>

namespace echocine {

namespace {

// The place after the string that begins at `at`; one of a single line ends with the line.
std::size_t afterString(std::string_view text, std::size_t at) {
  const char quote = text[at];
  const auto isLong = [&](std::size_t i) {
    return i + 2 < text.size() && text[i] == quote && text[i + 1] == quote && text[i + 2] == quote;
  };
  const bool long_one = isLong(at);
  for (at += long_one ? 3 : 1; at < text.size(); ++at) {
    if (text[at] == '\\' && quote == '"') {
      ++at;
    } else if (long_one && isLong(at)) {
      at += 3;  // up to two quotes of its own may stand before those that end it
      for (int own = 0; own < 2 && at < text.size() && text[at] == quote; ++own) ++at;
      return at;
    } else if (!long_one && text[at] == quote) {
      return at + 1;
    } else if (!long_one && text[at] == '\n') {
      return at;
    }
  }
  return text.size();
}

}  // namespace

int lineNestedTooDeep(std::string_view text) {
  int line = 1, brackets = 0, dots = 0;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '"' || c == '\'') {
      const std::size_t end = std::min(text.size(), afterString(text, at));
      line += static_cast<int>(std::count(text.begin() + static_cast<std::ptrdiff_t>(at),
                                          text.begin() + static_cast<std::ptrdiff_t>(end), '\n'));
      at = end;
      continue;
    }
    if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
      continue;
    }
    if (c == '\n') ++line;
    if (c == '[' || c == '{') ++brackets;
    if ((c == ']' || c == '}') && brackets > 0) --brackets;
    if (c == '.') ++dots;
    if (c == '\n' || c == '=' || c == ',' || c == '[' || c == '{') dots = 0;
    if (dots >= kMaxTomlNesting || brackets > kMaxTomlNesting) return line;
    ++at;
  }
  return 0;
}

}  // namespace echocine
