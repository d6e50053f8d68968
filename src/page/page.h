#pragma once
// Pages of results: a single HTML file that works offline. Style, scripts, chart library, data and
// images are embedded, and its content policy prevents the browser from fetching anything.

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

// The common parts of all pages: style, chart library, helpers (page.js), player and curves,
// followed by the page's own `script`. Both texts must outlive the result.
PageLook pageLook(std::string title, std::string_view body, std::string_view script);

// The scripts of HeartView: three.js, and the 3-D drawing of meshes and sector. They run after
// page.js.
std::vector<std::string_view> heartViewScripts();

// Writes a page sequentially; its memory does not grow with the images. Until finish() the page is
// in a temporary file, which is removed if finish() is not called.
class PageWriter {
 public:
  PageWriter(const std::filesystem::path& path, const PageLook& look);  // throws JobError

  // The next frame of a loop, JPEG or PNG; page.js finds it by frames(loop). Throws JobError.
  void addFrame(std::string_view loop, std::span<const std::byte> image);

  // Data of the page, `page.data` in JavaScript. NaN becomes null. Throws JobError.
  void finish(const nlohmann::ordered_json& data);

 private:
  void put(std::string_view text);
  void flush();

  WholeFile file_;
  std::string buffer_;
  std::vector<std::string_view> scripts_;
};

// A page shows each frame, or for long loops every second, third, ..., so that browsers can open
// it: at most 400 (our choice; 30 MB of pictures of 800 x 600).
int pageStride(int frames);

// A page whose images, if any, are in its data as dataUri(). Throws JobError.
void writePage(const std::filesystem::path& path, const PageLook& look,
               const nlohmann::ordered_json& data);

// The same as text, for a server: its scripts may ask the server that has sent the page.
std::string servedPage(const PageLook& look, const nlohmann::ordered_json& data);

// "data:image/png;base64,..." for the src of an <img>. Precondition: JPEG or PNG.
std::string dataUri(std::span<const std::byte> image);

}  // namespace echocine
