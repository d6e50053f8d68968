#pragma once
// Lists as options have them.

#include <string>
#include <vector>

namespace echocine::compare {

// "a,b" at "," is a and b; an empty text is one empty part.
inline std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts{""};
  for (const char c : text)
    if (c == at)
      parts.emplace_back();
    else
      parts.back() += c;
  return parts;
}

}  // namespace echocine::compare
