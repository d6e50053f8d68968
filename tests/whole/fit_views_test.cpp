// Which view of a heart a loop shows, told by labels, boundaries and motion alone; and what the
// page of a scan has of it. All views of three hearts: tests/bench/views_main.cpp.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "core/parallel.h"
#include "fit/dial_scan.h"
#include "fit/heart_family.h"
#include "fit/model_discrepancy.h"
#include "support/echo_video.h"
#include "support/page_data.h"
#include "support/temp_folder.h"
#include "support/view_loops.h"

namespace echocine::fit {

using namespace echo;
namespace {

using namespace support;

// Segmented chambers under another scanner's media, gain, grey curve and speckle. The bound is half
// of the least margin that the table has for this heart.
TEST(CompareViews, AWholeHeartIsSeenInItsView) {
  if (!realHeartsThere()) GTEST_SKIP() << "no real hearts beside the project";
  withThreads(2, [] {
    const EchoLoop loop = scannedLoop(sceneOf(Family::whole, View::psax_mid), 10, 16);
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
    const EchoLoop loop = scannedLoop(sceneOf(Family::shipped, View::a4c), 10, 3);
    SideOptions side;
    side.ed_frame = 0;
    const ModelLoop first = family.at({0.45});
    const ModelDiscrepancy discrepancy(loop, side, first);
    // Found, not given: models and loop have the same heart rate.
    EXPECT_NEAR(discrepancy.beat().span.systole, first.systole, 0.02);
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

// Offsets in mm at the end of systole where segment `still` of the loop does not move and the
// model's does: of that segment, and the largest of the others.
std::pair<double, double> offsetsWithStill(std::size_t still, Look look) {
  heart::Parameters planted = heart::parametersFrom({{"ef", 0.5}});
  planted.segments[still - 1].amplitude = 0;
  const EchoLoop loop = scannedLoop(heart::heartScene(planted, View::a4c, 16, look), 16, 23);
  SideOptions side;
  side.ed_frame = 0;
  const SceneFit fit =
      fitScene(heart::heartScene(heart::parametersFrom({}), View::a4c, 20, look), loop, side);
  double found = 0, next = 0;
  for (const OffsetCurve& curve : segmentCurves(fit.where.map)) {
    double mean = 0;
    for (std::size_t n = 5; n < 9; ++n) mean += curve.offset_mm[n] / 4;
    if (static_cast<std::size_t>(curve.part) == still)
      found = mean;
    else
      next = std::max(next, mean);
  }
  std::printf("segment %zu stands still: %+.1f mm, the next one %+.1f mm\n", still, found, next);
  return {found, next};
}

// A wall that stands still in the loop and moves in the model: at the end of systole its edges lie
// outside the model's chamber, by far more than those of any other segment. With whole borders that
// holds for the mid anterolateral wall (12); behind an uneven chest wall, which hides that one, for
// the mid inferoseptal wall (9).
TEST(CompareViews, AStillSegmentIsWhereTheSceneDisagrees) {
  withThreads(2, [] {
    for (const auto& [segment, look] : {std::pair{12u, Look::clean}, {9u, Look::scanner}}) {
      const auto [found, next] = offsetsWithStill(segment, look);
      EXPECT_GT(found, 1.8);
      EXPECT_LT(next, found - 0.8);
    }
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
  const nlohmann::json& fit = data["fit"];
  ASSERT_EQ(fit["map"].size(), static_cast<std::size_t>(kFitFrames));
  for (const nlohmann::json& frame : fit["map"]) {
    EXPECT_FALSE(frame["region"].empty());
    ASSERT_FALSE(frame["boundary"].empty());
    for (const nlohmann::json& p : frame["boundary"]) {
      ASSERT_EQ(p.size(), 7u);
      EXPECT_LE(std::abs(p[2].get<double>()), 8);
      EXPECT_LT(p[5].get<std::size_t>(), fit["structures"].size());
      EXPECT_LE(p[6].get<int>(), 17);
    }
  }
  EXPECT_EQ(fit["curves"], file["curves_of_best"]);
  EXPECT_EQ(fit["segments"], file["segments_of_best"]);
  bool cavity = false;
  for (const nlohmann::json& curve : file["curves_of_best"])
    cavity = cavity || curve["structure"] == "lv_cavity";
  EXPECT_TRUE(cavity);
  EXPECT_FALSE(file.contains("fit"));
  // The walls that a four-chamber view shows, and the cap between them.
  std::set<std::string> segments;
  for (const nlohmann::json& curve : file["segments_of_best"]) segments.insert(curve["segment"]);
  for (const char* name : {"basal inferoseptal", "mid inferoseptal", "apical septal", "apex",
                           "apical lateral", "mid anterolateral", "basal anterolateral"})
    EXPECT_TRUE(segments.contains(name)) << name;
  EXPECT_FALSE(segments.contains("mid inferior"));
  EXPECT_FALSE(segments.contains("mid anterior"));
}

}  // namespace
}  // namespace echocine::fit
