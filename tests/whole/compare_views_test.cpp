// Which view of a heart a loop shows, told by labels, boundaries and motion alone; and what the
// page of a scan has of it. All views of three hearts: tests/bench/views_main.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/dial_scan.h"
#include "compare/heart_family.h"
#include "compare/model_discrepancy.h"
#include "support/echo_video.h"
#include "support/page_data.h"
#include "support/temp_folder.h"
#include "support/view_loops.h"

namespace echocine::compare {
namespace {

using namespace support;

// Segmented chambers under another scanner's media, gain, grey curve and speckle. The bound is half
// of the least margin that the table has for this heart.
TEST(CompareViews, AWholeHeartIsSeenInItsView) {
  if (!realHeartsThere()) GTEST_SKIP() << "no real hearts beside the project";
  withThreads(2, [] {
    const Loop loop = scannedLoop(sceneOf(Family::whole, View::psax_mid), 10, 16);
    SideOptions side;
    side.ed_frame = 0;
    std::vector<double> values;
    for (const View view : {View::psax_mid, View::a2c, View::plax}) {
      const Scene scene = sceneOf(Family::whole, view);
      const ModelLoop model = modelLoop(scene, MeshMotion(scene), kFitFrames);
      values.push_back(ModelDiscrepancy(loop, side, model).search(model).discrepancy);
    }
    EXPECT_LT(values[0], values[1] - 0.1);
    EXPECT_LT(values[0], values[2] - 0.1);
    std::printf("whole heart, psax-mid: %.3f, as a2c %.3f, as plax %.3f\n", values[0], values[1],
                values[2]);
  });
}

// Along the ejection fraction D is smooth: what the best cubic leaves of five neighbours is 6/70 of
// their fourth difference at most.
TEST(CompareViews, DiscrepancyIsSmoothInADial) {
  withThreads(2, [] {
    const HeartFamily family({{"hr", 72}, {"edv", 150}, {"wall-thickness", 11}},
                             {{"ef", 0.4, 0.55}}, heart::View::a4c, kFitFrames, 3);
    const Loop loop = scannedLoop(sceneOf(Family::shipped, View::a4c), 10, 3);
    SideOptions side;
    side.ed_frame = 0;
    const ModelLoop first = family.at({0.45});
    const ModelDiscrepancy discrepancy(loop, side, first);
    const FitPose pose = discrepancy.search(first).pose;
    std::vector<double> y;
    for (int i = 0; i < 9; ++i)
      y.push_back(discrepancy.refine(family.at({0.42 + 0.01 * i}), {pose}).discrepancy);
    double worst = 0;
    for (std::size_t i = 2; i + 2 < y.size(); ++i)
      worst = std::max(
          worst, 6.0 / 70 * std::abs(y[i - 2] - 4 * y[i - 1] + 6 * y[i] - 4 * y[i + 1] + y[i + 2]));
    EXPECT_LT(worst, 0.002);
    const auto least = std::min_element(y.begin(), y.end()) - y.begin();
    std::printf("least at EF %.2f of 0.45, residual to local cubics %.5f\n",
                0.42 + 0.01 * static_cast<double>(least), worst);
  });
}

// Every picture of the beat has its boundary, its offsets lie within the search along the normal,
// and the curves are those of the file.
TEST(CompareViews, TheScansPageShowsWhereTheBestHeartDisagrees) {
  TempFolder folder;
  writeLossless(folder / "rings.avi", Drawing{});
  withThreads(2, [&] {
    ScanOptions options;
    options.real = folder / "rings.avi";
    options.side.ed_frame = 0;
    options.side.mm_per_pixel = 0.6;
    options.axes = parseScan("ef=0.5:0.6:0.1");
    writeScan(scanDials(options), folder / "scan");
  });
  const nlohmann::json data = dataOf(bytesOf(folder / "scan/scan.html")),
                       file = nlohmann::json::parse(bytesOf(folder / "scan/scan.json"));
  ASSERT_EQ(data["map"].size(), static_cast<std::size_t>(kFitFrames));
  for (const nlohmann::json& frame : data["map"]) {
    EXPECT_FALSE(frame["region"].empty());
    ASSERT_FALSE(frame["boundary"].empty());
    for (const nlohmann::json& p : frame["boundary"]) {
      ASSERT_EQ(p.size(), 6u);
      EXPECT_LE(std::abs(p[2].get<double>()), 8);
      EXPECT_LT(p[5].get<std::size_t>(), data["structures"].size());
    }
  }
  EXPECT_EQ(data["curves_of_best"], file["curves_of_best"]);
  bool cavity = false;
  for (const nlohmann::json& curve : file["curves_of_best"])
    cavity = cavity || curve["structure"] == "lv_cavity";
  EXPECT_TRUE(cavity);
  EXPECT_FALSE(file.contains("map"));
}

}  // namespace
}  // namespace echocine::compare
