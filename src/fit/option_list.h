#pragma once
// Lists as options have them.

#include <string>
#include <vector>

namespace echocine::fit {

// "a,b" at "," is a and b; an empty text is one empty part.
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
