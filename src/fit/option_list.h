#pragma once
// Lists in options.

#include <string>
#include <vector>

namespace echocine::fit {

// Splits "a,b" at "," into a and b. An empty text is one empty part.
inline std::vector<std::string> splitOption(const std::string& text, char at) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

}  // namespace echocine::fit
