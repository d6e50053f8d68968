#include "page/page.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base64.h"
#include "core/check.h"
#include "page/assets.h"

namespace echocine {

namespace {

constexpr std::size_t kBufferBytes = 1 << 18;

// Nothing may be fetched; scripts and styles are those in the file.
constexpr std::string_view kPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:";
// A page of a server may ask that server.
constexpr std::string_view kAsksItsServer = "; connect-src 'self'";

std::string escapedHtml(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

// JSON that is safe in a <script>: without "<" neither "</script" nor "<!--" can end or change
// it, and the two line separators that JavaScript once took for line ends are escaped. All three
// occur within strings only. Bytes that are not UTF-8 (names of files) become U+FFFD.
std::string scriptJson(const nlohmann::ordered_json& data) {
  const std::string json = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string out;
  out.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::string_view rest = std::string_view(json).substr(i, 3);
    if (json[i] == '<') {
      out += "\\u003c";
    } else if (rest == "\xE2\x80\xA8" || rest == "\xE2\x80\xA9") {
      out += rest == "\xE2\x80\xA8" ? "\\u2028" : "\\u2029";
      i += 2;
    } else {
      out += json[i];
    }
  }
  return out;
}

std::string_view mediaType(std::span<const std::byte> image) {
  CHECK_LT(4u, image.size());
  const bool jpeg = image[0] == std::byte{0xFF} && image[1] == std::byte{0xD8};
  const bool png = image[0] == std::byte{0x89} && image[1] == std::byte{'P'};
  CHECK_EQ(jpeg || png, true);
  return jpeg ? "image/jpeg" : "image/png";
}

// All that stands before frames and data.
std::string headOf(const PageLook& look, std::string_view more_policy) {
  std::string out =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"";
  out += kPolicy;
  out += more_policy;
  out +=
      "\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<link rel=\"icon\" href=\"data:,\">\n<title>";
  out += escapedHtml(look.title) + "</title>\n";
  for (const std::string_view style : look.styles) {
    CHECK_EQ(style.find("</style"), std::string_view::npos);
    out.append("<style>\n").append(style).append("</style>\n");
  }
  return out.append("</head>\n<body>\n").append(look.body);
}

// Data and scripts.
std::string tailOf(const nlohmann::ordered_json& data, std::span<const std::string_view> scripts) {
  std::string out =
      "<script type=\"application/json\" id=\"data\">" + scriptJson(data) + "</script>\n";
  for (const std::string_view script : scripts) {
    CHECK_EQ(script.find("</script"), std::string_view::npos);
    out.append("<script>\n").append(script).append("</script>\n");
  }
  return out + "</body>\n</html>\n";
}

}  // namespace

std::vector<std::string_view> heartViewScripts() {
  return {pageAsset("three.min.js"), pageAsset("heart_surface.js"), pageAsset("heart_space.js"),
          pageAsset("heart_view.js")};
}

PageLook pageLook(std::string title, std::string_view body, std::string_view script) {
  return {std::move(title),
          {pageAsset("page.css")},
          body,
          {pageAsset("echarts.common.min.js"), pageAsset("page.js"), pageAsset("player.js"),
           pageAsset("curves.js"), script}};
}

PageWriter::PageWriter(const std::filesystem::path& path, const PageLook& look)
    : file_(path), scripts_(look.scripts) {
  put(headOf(look, ""));
}

void PageWriter::put(std::string_view text) {
  buffer_ += text;
  if (buffer_.size() >= kBufferBytes) flush();
}

void PageWriter::flush() {
  file_.write(std::as_bytes(std::span(buffer_)));
  buffer_.clear();
}

// A script of a type that no browser runs: text that is kept and not laid out.
void PageWriter::addFrame(std::string_view loop, std::span<const std::byte> image) {
  put("<script type=\"");
  put(mediaType(image));
  put("\" data-loop=\"");
  put(escapedHtml(loop));
  put("\">");
  put(base64(image));
  put("</script>\n");
}

void PageWriter::finish(const nlohmann::ordered_json& data) {
  put(tailOf(data, scripts_));
  flush();
  file_.finish();
}

std::string servedPage(const PageLook& look, const nlohmann::ordered_json& data) {
  return headOf(look, kAsksItsServer) + tailOf(data, look.scripts);
}

int pageStride(int frames) {
  constexpr int kMostFrames = 400;
  return std::max(1, (frames + kMostFrames - 1) / kMostFrames);
}

void writePage(const std::filesystem::path& path, const PageLook& look,
               const nlohmann::ordered_json& data) {
  PageWriter writer(path, look);
  writer.finish(data);
}

std::string dataUri(std::span<const std::byte> image) {
  return "data:" + std::string(mediaType(image)) + ";base64," + base64(image);
}

}  // namespace echocine
