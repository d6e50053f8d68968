#pragma once
// Pages of results: ONE file of HTML that opens anywhere, offline, for as long as there are
// browsers. Style, scripts, chart library, data and images stand in the file itself, and its
// content policy forbids the browser to fetch anything.

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/file.h"

namespace echocine {

struct PageLook {
  std::string title;                      // plain text
  std::vector<std::string_view> styles;   // CSS
  std::string_view body;                  // HTML within <body>
  std::vector<std::string_view> scripts;  // JavaScript, run in this order after body and data
};

// The look of all pages: common style, chart library, helpers (page.js), player and curves, then
// `script` of the page itself. Both are texts that outlive the look.
PageLook pageLook(std::string title, std::string_view body, std::string_view script);

// Writes a page in one go through memory that does not grow with its images. Until finish() the
// page stands in a part beside it; destroyed without it, nothing is left behind.
class PageWriter {
 public:
  PageWriter(const std::filesystem::path& path, const PageLook& look);  // throws JobError

  // The next frame of a loop, JPEG or PNG; page.js finds it by frames(loop). Throws JobError.
  void addFrame(std::string_view loop, std::span<const std::byte> image);

  // Data of the page, in JavaScript `page.data`. Not-a-number becomes null. Throws JobError.
  void finish(const nlohmann::ordered_json& data);

 private:
  void put(std::string_view text);
  void flush();

  WholeFile file_;
  std::string buffer_;
  std::vector<std::string_view> scripts_;
};

// A page with frames shows each, or of long loops every second, third, ..., so that it stays of a
// size that browsers open: 400 at most (our choice; 30 MB of pictures of 800 x 600).
int pageStride(int frames);

// A page whose images, if any, stand in its data as dataUri(). Throws JobError.
void writePage(const std::filesystem::path& path, const PageLook& look,
               const nlohmann::ordered_json& data);

// "data:image/png;base64,..." for the src of an <img>. Precondition: JPEG or PNG.
std::string dataUri(std::span<const std::byte> image);

}  // namespace echocine
