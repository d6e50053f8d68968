#pragma once
// Makes a message one line, whatever names it quotes.

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>

namespace echocine {

// Longest word or quotation of a message, and longest message; our choice.
inline constexpr std::size_t kLongestQuote = 200, kLongestLine = 2000;

// Keeps both ends, which are the most informative: the root and the file of a path.
inline std::string shortened(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return std::string(text);
  const std::size_t half = (longest - 5) / 2;
  return fmt::format("{} ... {}", text.substr(0, half), text.substr(text.size() - half));
}

// Shortens words and quotations of more than kLongestQuote characters in the middle.
inline std::string withShortWords(std::string_view text) {
  std::string line;
  while (!text.empty()) {
    const bool quoted = text.front() == '"' && text.find('"', 1) != std::string_view::npos;
    const std::size_t end = quoted ? text.find('"', 1) + 1
                            : text.front() == ' ' || text.front() == '"'
                                ? 1
                                : std::min(text.find_first_of(" \""), text.size());
    line += shortened(text.substr(0, end), kLongestQuote);
    text.remove_prefix(end);
  }
  return line;
}

// Escapes control characters, such as line breaks in a quoted key: \x0a. Truncates long messages.
inline std::string oneLine(std::string_view text) {
  std::string line;
  for (const char c : shortened(withShortWords(text), kLongestLine)) {
    const auto byte = static_cast<unsigned char>(c);
    line += byte < 0x20 || byte == 0x7f ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
  }
  return line;
}

}  // namespace echocine
