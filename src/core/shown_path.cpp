#include "core/shown_path.h"

#include <algorithm>
#include <string_view>

namespace echocine {

std::string shownName(const std::filesystem::path& path) {
  const std::filesystem::path p = path.lexically_normal();
  return (p.has_filename() ? p : p.parent_path()).filename().string();
}

std::string withoutFolders(std::string text, const std::filesystem::path& folder) {
  const std::string known = folder.string() + "/";
  if (folder.is_absolute())
    for (std::size_t at = 0; (at = text.find(known, at)) != std::string::npos;)
      text.erase(at, known.size());
  // An absolute path begins a word, and ends where the word or the name of its file does.
  constexpr std::string_view kBefore = " \"'(,", kAfter = " \"'),";
  for (std::size_t at = 0; (at = text.find('/', at)) != std::string::npos;) {
    const bool begins = at == 0 || kBefore.find(text[at - 1]) != std::string_view::npos;
    const std::size_t end = std::min(text.find_first_of(kAfter, at), text.size());
    const std::size_t name = text.find_last_of('/', end - 1) + 1;
    if (begins && name > at + 1) text.erase(at, name - at);
    ++at;
  }
  return text;
}

}  // namespace echocine
