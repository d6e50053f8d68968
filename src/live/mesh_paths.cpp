#include "live/mesh_paths.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace echocine::live {

namespace fs = std::filesystem;

namespace {

bool isRelativeMesh(std::string_view word) {
  constexpr std::array<std::string_view, 4> kEnds{".obj", ".ply", ".stl", ".off"};
  return !word.starts_with('/') && std::any_of(kEnds.begin(), kEnds.end(), [&](auto end) {
    if (word.size() < end.size()) return false;
    const std::string_view last = word.substr(word.size() - end.size());
    return std::equal(last.begin(), last.end(), end.begin(),
                      [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + 32 : a) == b; });
  });
}

}  // namespace

std::string withMeshesFrom(const std::string& text, const fs::path& from, const fs::path& to) {
  const fs::path start = from.empty() ? fs::path(".") : from;
  const fs::path way = fs::proximate(start, to.empty() ? fs::path(".") : to);
  if (way == ".") return text;
  std::string made;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    std::size_t end = i + 1;
    if (c == '#') {
      end = std::min(text.find('\n', i), text.size());
    } else if (c == '"' || c == '\'') {
      while (end < text.size() && text[end] != c && text[end] != '\n')
        end += c == '"' && text[end] == '\\' ? 2 : 1;
      end = std::min(end + 1, text.size());
      if (isRelativeMesh(std::string_view(text).substr(i + 1, end - i - 2))) {
        made += c + way.generic_string() + '/';
        ++i;
      }
    }
    made.append(text, i, end - i);
    i = end;
  }
  return made;
}

}  // namespace echocine::live
