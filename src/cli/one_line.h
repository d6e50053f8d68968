#pragma once
// One line of text, whatever names it quotes.

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace echocine {

// Control characters, such as line breaks within a quoted key, spelled out: \x0a.
inline std::string oneLine(std::string_view text) {
  std::string line;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    line += byte < 0x20 || byte == 0x7f ? fmt::format("\\x{:02x}", byte) : std::string(1, c);
  }
  return line;
}

}  // namespace echocine
