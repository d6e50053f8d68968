// report.html of runs with and without pictures. What it shows is tested in a browser.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/base64.h"
#include "support/loop_scene.h"
#include "support/page_data.h"
#include "support/run_program.h"

namespace echocine {
namespace {

using namespace support;
namespace fs = std::filesystem;

struct Report {
  std::vector<std::string> types, frames;
  nlohmann::json data;
};

class Reports : public ::testing::Test {
 protected:
  std::string render(const Lines& output, const std::string& more = "") {
    SceneText text = ballScene(5);
    for (const auto& [key, value] : output) text.output[key] = value;
    const Outcome outcome = renderScene(writeBall(folder, text), out, more + " --overwrite");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return fs::exists(out / "report.html") ? bytesOf(out / "report.html") : "";
  }
  static Report parse(const std::string& html) {
    Report report;
    for (const PageFrame& frame : pageFrames(html, "cine")) {
      report.types.push_back(frame.type);
      report.frames.push_back(frame.base64);
    }
    const std::string opening = "id=\"data\">";
    const std::size_t from = html.find(opening) + opening.size();
    report.data = nlohmann::json::parse(html.substr(from, html.find("</script>", from) - from));
    return report;
  }
  TempFolder folder;
  const fs::path out = folder / "out";
};

TEST_F(Reports, HoldTheVeryFramesOfTheCine) {
  const Report report = parse(render({}));
  ASSERT_EQ(report.frames.size(), 5u);
  std::string cine = bytesOf(out / "cine.avi");
  for (const std::string& frame : report.frames) {
    const std::size_t before = cine.size();
    // Each is found where the one before ended.
    std::size_t at = cine.find("\xFF\xD8\xFF");
    ASSERT_NE(at, std::string::npos);
    const std::size_t length = frame.size() / 4 * 3 - (frame.ends_with("==")  ? 2u
                                                       : frame.ends_with('=') ? 1u
                                                                              : 0u);
    EXPECT_EQ(base64(std::as_bytes(std::span(cine).subspan(at, length))), frame);
    cine.erase(0, at + length);
    EXPECT_LT(cine.size(), before);
  }
}

TEST_F(Reports, ShowPngFramesWhereTheCineIsNotForBrowsers) {
  for (const Lines& output :
       {Lines{{"png", "true"}, {"cine", "false"}}, Lines{{"png", "true"}, {"codec", "\"ffv1\""}}}) {
    const Report report = parse(render(output));
    ASSERT_EQ(report.frames.size(), 5u);
    for (int i = 0; i < 5; ++i) {
      const std::string png = bytesOf(out / ("png/frame_000" + std::to_string(i) + ".png"));
      EXPECT_EQ(report.frames[static_cast<std::size_t>(i)], base64(std::as_bytes(std::span(png))));
      EXPECT_EQ(report.types[static_cast<std::size_t>(i)], "image/png");
    }
  }
}

TEST_F(Reports, ShowJpegFramesOfALosslessCine) {
  const Report lossless = parse(render({{"codec", "\"ffv1\""}}));
  EXPECT_EQ(lossless.frames, parse(render({})).frames);
}

TEST_F(Reports, HaveNoFramesWhereNoPictureIsMade) {
  const Report report = parse(render({{"cine", "false"}}));
  EXPECT_TRUE(report.frames.empty());
  EXPECT_EQ(report.data["frames"]["index"].size(), 5u);
  EXPECT_EQ(report.data["measured"]["timings_ms_per_frame"]["avi"], 0);
}

TEST_F(Reports, CanBeLeftOutAndTakeAnEarlierOneWithThem) {
  EXPECT_NE(render({}), "");
  EXPECT_EQ(render({{"report", "false"}}), "");
}

TEST_F(Reports, OfAPartOfTheLoopKeepItsNumbers) {
  const Report report = parse(render({}, "--frames=2:4"));
  EXPECT_EQ(report.frames.size(), 2u);
  EXPECT_EQ(report.data["frames"]["index"], nlohmann::json({2, 3}));
  EXPECT_EQ(report.data["frames"]["volumes_ml"]["cavity"].size(), 2u);
  EXPECT_FALSE(report.data["frames"]["volumes_ml"].contains("leaflet"));
  EXPECT_NEAR(report.data["ecg"]["time_s"].front().get<double>(), 0.4, 1e-12);
  EXPECT_NEAR(report.data["ecg"]["time_s"].back().get<double>(), 0.8, 1e-12);
}

}  // namespace
}  // namespace echocine
