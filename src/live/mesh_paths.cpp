#include "live/mesh_paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "motion/heart/recording.h"
#include "scene/npz_keyframe.h"

namespace echocine::live {

namespace fs = std::filesystem;

namespace {

bool isRelativeMesh(std::string_view word) {
  if (npzKeyframeOf(fs::path(word))) return !word.starts_with('/');
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

std::string withNamesInMemory(std::string text, const heart::Recording& recording) {
  for (const heart::RecordedPart& part : recording.parts) {
    const std::string from = fmt::format("\"{}.npz\"", part.kind.name);
    const std::string to =
        fmt::format("\"{}{}.obj\"", part.kind.name, part.control_m.size() == 1 ? "" : "_??");
    if (const std::size_t at = text.find(from); at != std::string::npos)
      text.replace(at, from.size(), to);
  }
  return text;
}

}  // namespace echocine::live
