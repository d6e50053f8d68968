// The comparison's page: what it says of every frame is what was measured, and null where nothing
// was.

#include "compare/compare_page.h"

#include <gtest/gtest.h>

#include <limits>

#include "compare/results.h"
#include "support/page_data.h"
#include "support/temp_folder.h"

namespace echocine::compare {

using namespace echo;
namespace {

using nlohmann::json;
using support::countOf;

FrameMetrics someMetrics(double rms) {
  FrameMetrics m;
  m.rms = rms;
  m.psnr_db = rms > 0 ? 20 : std::numeric_limits<double>::infinity();
  m.ncc = 0.5;
  m.weight = 10;
  return m;
}

// A frame that was measured, one that the synthetic loop does not show, one that repeats.
Comparison threeFrames() {
  Comparison c;
  c.synthetic.label = "renders/my_loop/";
  c.real.label = "</script><b>patient.dcm";
  FrameResult measured, outside, repeat;
  measured.real_time_s = 0;
  measured.synthetic_place = 2.5;
  measured.synthetic_phase = 0.1;
  measured.before = someMetrics(12);
  measured.after = someMetrics(0);
  measured.discrepancy = 0.25;
  measured.bands = {{"lv", someMetrics(3)}};
  outside.real_frame = 1;
  outside.real_time_s = 0.04;
  repeat = measured;
  repeat.real_frame = 2;
  repeat.real_time_s = 0.08;
  repeat.repeat = true;
  repeat.bands.clear();
  c.frames = {measured, outside, repeat};
  c.mean_bands = {{"lv", someMetrics(3)}};
  return c;
}

const std::string kPng = "\x89PNG a picture";

std::span<const std::byte> pngBytes() {
  return std::as_bytes(std::span(kPng.data(), kPng.size()));
}

std::string pageOf(const Comparison& c) {
  const support::TempFolder folder;
  ComparePage page(folder / "compare.html", c);
  for (const FrameResult& f : c.frames)
    if (page.shows(f.real_frame))
      for (const Panel panel : {Panel::real, Panel::synthetic, Panel::difference})
        page.addFrame(panel, pngBytes());
  page.finish(summaryJson(c), pngBytes(), pngBytes());
  return support::bytesOf(folder / "compare.html");
}

TEST(ComparePage, HoldsEveryFramesNumbersAndNullWhereNothingWasMeasured) {
  const std::string html = pageOf(threeFrames());
  const json data = support::dataOf(html), frames = data.at("frames");
  EXPECT_EQ(data.at("stride"), 1);
  EXPECT_EQ(frames.at("real_frame"), json({0, 1, 2}));
  EXPECT_EQ(frames.at("synthetic_frame"), json({2.5, nullptr, 2.5}));
  EXPECT_EQ(frames.at("synthetic_phase"), json({0.1, nullptr, 0.1}));
  EXPECT_EQ(frames.at("counted"), json({true, false, false}));
  EXPECT_EQ(frames.at("repeat"), json({false, false, true}));
  EXPECT_EQ(frames.at("discrepancy"), json({0.25, nullptr, 0.25}));
  EXPECT_EQ(frames.at("before").at("rms"), json({12, nullptr, 12}));
  EXPECT_EQ(frames.at("before").at("psnr_db"), json({20, nullptr, 20}));
  EXPECT_EQ(frames.at("after").at("psnr_db"), json({nullptr, nullptr, nullptr}));  // infinite
  EXPECT_EQ(frames.at("bands").at("lv").at("rms"), json({3, nullptr, nullptr}));
  for (const auto& [key, values] : frames.at("after").items()) EXPECT_EQ(values.size(), 3u) << key;
}

// A structure that the view does not show.
TEST(ComparePage, WhatIsNotInSightHasNoScoreInSummaryAndPage) {
  Comparison c = threeFrames();
  c.mean_bands.push_back({"elsewhere", {}});
  c.frames[0].bands.push_back({"elsewhere", {}});
  const json data = support::dataOf(pageOf(c)), summary = data.at("summary");
  for (const auto& [key, value] : summary.at("bands_after_calibration").at("elsewhere").items())
    EXPECT_TRUE(value.is_null()) << key;
  for (const auto& [key, values] : data.at("frames").at("bands").at("elsewhere").items())
    EXPECT_EQ(values, json({nullptr, nullptr, nullptr})) << key;
  EXPECT_EQ(summary.at("bands_after_calibration").at("lv").at("rms"), 3);
}

TEST(ComparePage, HoldsThePicturesOfAllPanelsAndTheSummary) {
  const Comparison c = threeFrames();
  const std::string html = pageOf(c);
  for (const char* panel : {"real", "synthetic", "difference"})
    EXPECT_EQ(countOf(html, std::string("data-loop=\"") + panel + "\""), 3u) << panel;
  const json data = support::dataOf(html);
  EXPECT_EQ(data.at("summary"), json::parse(summaryJson(c).dump()));
  for (const char* sector : {"sector_real", "sector_synthetic"})
    EXPECT_TRUE(data.at(sector).get<std::string>().starts_with("data:image/png;base64,"));
}

TEST(ComparePage, ItsTitleNamesBothLoopsAndIsNoMarkup) {
  const std::string html = pageOf(threeFrames());
  EXPECT_NE(
      html.find("<title>EchoCine: renders/my_loop/ against &lt;/script&gt;&lt;b&gt;patient.dcm<"),
      std::string::npos)
      << html.substr(html.find("<title>"), 100);
  EXPECT_EQ(countOf(html, "<b>patient"), 0u);
}

TEST(ComparePage, LongLoopsAreThinned) {
  Comparison c = threeFrames();
  const FrameResult one = c.frames.front();
  c.frames.assign(1000, one);
  for (int i = 0; i < 1000; ++i) c.frames[static_cast<std::size_t>(i)].real_frame = i;
  const json data = support::dataOf(pageOf(c));
  EXPECT_EQ(data.at("stride"), 3);
  EXPECT_EQ(data.at("frames").at("real_frame").size(), 334u);
  EXPECT_EQ(data.at("frames").at("real_frame").at(1), 3);
  EXPECT_EQ(data.at("summary").at("frames_total"), 1000);
}

TEST(ComparePage, HasItsNameOnlyWhenItIsWhole) {
  const support::TempFolder folder;
  const Comparison c = threeFrames();
  {
    ComparePage page(folder / "compare.html", c);
    page.addFrame(Panel::real, pngBytes());
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace echocine::compare
