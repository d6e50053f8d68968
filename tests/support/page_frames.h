#pragma once
// The pictures that a page holds.

#include <string>
#include <string_view>
#include <vector>

namespace echocine::support {

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
