#pragma once
// What stands in a page.

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace echocine::support {

inline std::size_t countOf(const std::string& text, const std::string& what) {
  std::size_t count = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1))
    ++count;
  return count;
}

// The data as the browser's JSON.parse() finds them.
inline nlohmann::json dataOf(const std::string& html) {
  const std::string opening = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = html.find(opening) + opening.size();
  return nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from));
}

struct PageFrame {
  std::string type, base64;  // "image/jpeg"

  bool operator==(const PageFrame&) const = default;
};

// Those of a loop, in order.
inline std::vector<PageFrame> pageFrames(std::string_view html, const std::string& loop) {
  const std::string_view opening = "<script type=\"";
  const std::string middle = "\" data-loop=\"" + loop + "\">";
  std::vector<PageFrame> frames;
  for (std::size_t at = 0; (at = html.find(opening, at)) != html.npos;) {
    at += opening.size();
    const std::size_t type_end = html.find('"', at);
    if (type_end == html.npos || !html.substr(type_end).starts_with(middle)) continue;
    const std::size_t begin = type_end + middle.size(), end = html.find('<', begin);
    frames.push_back({std::string(html.substr(at, type_end - at)),
                      std::string(html.substr(begin, end - begin))});
    at = begin;
  }
  return frames;
}

}  // namespace echocine::support
