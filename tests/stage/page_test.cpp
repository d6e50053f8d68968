// Pages: whatever the data hold, the file is one page that brings everything with it.

#include "page/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/base64.h"
#include "core/error.h"
#include "page/assets.h"
#include "support/page_data.h"
#include "support/temp_folder.h"

namespace echocine {
namespace {

namespace fs = std::filesystem;
using support::countOf;
using support::dataOf;
using support::TempFolder;

std::span<const std::byte> asBytes(std::string_view text) {
  return std::as_bytes(std::span(text));
}

const PageLook kSmall{"a <b> & \"c\"", {"body { margin: 0 }"}, "<p>here</p>\n", {"void 0;\n"}};

TEST(Base64, IsThatOfTheStandardsVectors) {
  const std::pair<const char*, const char*> vectors[] = {{"", ""},
                                                         {"f", "Zg=="},
                                                         {"fo", "Zm8="},
                                                         {"foo", "Zm9v"},
                                                         {"foob", "Zm9vYg=="},
                                                         {"fooba", "Zm9vYmE="},
                                                         {"foobar", "Zm9vYmFy"}};
  for (const auto& [plain, coded] : vectors) EXPECT_EQ(base64(asBytes(plain)), coded);
}

TEST(Page, DataCannotLeaveTheirScript) {
  const TempFolder folder;
  const std::string hostile =
      "</script><script>alert(1)</script><!-- \xE2\x80\xA8 \xE2\x80\xA9 \\ \" '";
  writePage(folder.path() / "p.html", kSmall, {{hostile, hostile}, {"n", 0.1}});
  const std::string html = support::bytesOf(folder.path() / "p.html");
  EXPECT_EQ(countOf(html, "</script>"), 2u);  // of data and of the one script
  EXPECT_EQ(countOf(html, "<!--"), 0u);
  EXPECT_EQ(countOf(html, "\xE2\x80\xA8"), 0u);
  EXPECT_EQ(countOf(html, "\xE2\x80\xA9"), 0u);
  EXPECT_EQ(dataOf(html)[hostile], hostile);
  EXPECT_EQ(dataOf(html)["n"], 0.1);
}

TEST(Page, TitleIsTextAndNeverMarkup) {
  const TempFolder folder;
  writePage(folder.path() / "p.html", kSmall, {});
  EXPECT_NE(support::bytesOf(folder.path() / "p.html")
                .find("<title>a &lt;b&gt; &amp; &quot;c&quot;</title>"),
            std::string::npos);
}

TEST(Page, NamesThatAreNotUtf8AndNumbersThatAreNoneStillMakeAPage) {
  const TempFolder folder;
  writePage(folder.path() / "p.html", kSmall, {{"name", "m\xFCller"}, {"x", std::nan("")}});
  const nlohmann::json data = dataOf(support::bytesOf(folder.path() / "p.html"));
  EXPECT_EQ(data["name"], "m\xEF\xBF\xBDller");
  EXPECT_TRUE(data["x"].is_null());
}

TEST(Page, FramesKeepTheirOrderLoopAndBytes) {
  const TempFolder folder;
  const std::string jpeg = "\xFF\xD8\xFF 1 jpeg", png = "\x89PNG 2 png";
  PageWriter writer(folder.path() / "p.html", kSmall);
  for (const std::string& image : {jpeg, png, jpeg}) writer.addFrame("cine", asBytes(image));
  writer.finish({});
  const std::string html = support::bytesOf(folder.path() / "p.html");
  const std::vector<support::PageFrame> expected{{"image/jpeg", base64(asBytes(jpeg))},
                                                 {"image/png", base64(asBytes(png))},
                                                 {"image/jpeg", base64(asBytes(jpeg))}};
  EXPECT_EQ(support::pageFrames(html, "cine"), expected);
}

TEST(Page, HasItsNameOnlyWhenItIsWhole) {
  const TempFolder folder;
  {
    PageWriter writer(folder.path() / "p.html", kSmall);
    writer.addFrame("cine", asBytes("\xFF\xD8\xFF a frame"));
    EXPECT_FALSE(fs::exists(folder.path() / "p.html"));
  }
  EXPECT_TRUE(fs::is_empty(folder.path()));
  EXPECT_THROW(writePage(folder.path() / "absent" / "p.html", kSmall, {}), JobError);
}

TEST(Page, LongLoopsAreThinnedEvenlyToWhatBrowsersOpen) {
  for (const int frames : {0, 1, 46, 400}) EXPECT_EQ(pageStride(frames), 1) << frames;
  EXPECT_EQ(pageStride(401), 2);
  for (int frames = 1; frames < 100000; frames += 97) {
    const int stride = pageStride(frames), shown = (frames + stride - 1) / stride;
    EXPECT_LE(shown, 400) << frames;
    EXPECT_TRUE(stride == 1 || frames > 400 * (stride - 1)) << frames;
  }
}

// The browser's content policy would stop these; a page that asks for them is a mistake already.
// The page of `live` asks its own server.
TEST(Page, AssetsFetchNothingAndCannotEndTheirElement) {
  for (std::size_t i = 0; i < kAssetCount; ++i) {
    const std::string name = kAssets[i].name;
    const std::string text(pageAsset(name));
    EXPECT_GT(text.size(), 10u) << name;
    if (!name.ends_with(".html")) {
      EXPECT_EQ(text.find("</script"), std::string::npos) << name;
      EXPECT_EQ(text.find("</style"), std::string::npos) << name;
    }
    if (name.ends_with(".min.js")) continue;  // other people's
    for (const char* fetching : {"@import", "url(", "fetch(", "XMLHttpRequest", "importScripts",
                                 "\nimport ", "src=\"", "href=\"http"}) {
      const bool asks_its_server =
          name == "live_server.js" && fetching == std::string_view("fetch(");
      EXPECT_EQ(text.find(fetching) == std::string::npos, !asks_its_server) << name << fetching;
    }
  }
}

}  // namespace
}  // namespace echocine
