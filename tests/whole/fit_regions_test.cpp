// Defects of the septum are found where they are; a perfect model shows nothing. "scanner" loses
// the borders of the hole. More hearts and looks: tests/bench/defects_main.cpp.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/parallel.h"
#include "fit/fit_regions.h"
#include "support/planted_defects.h"

namespace echocine::fit {
namespace {

using namespace support;

Scene small(Scene scene) {
  scene.probe.lines = 80;
  scene.probe.samples = 384;
  return scene;
}

TEST(FitRegions, DefectsOfTheSeptumAreFoundInItAndAPerfectModelShowsNone) {
  withThreads(2, [] {
    const std::map<std::string, double> dials{{"ef", 0.55}, {"edv", 140}};
    constexpr int kKeyframes = 10;
    const Scene healthy =
        small(defectScene(dials, Defect::none, View::a4c, kKeyframes, Look::smooth));
    const PerfectModel perfect(healthy);
    int seed = 300;
    for (const Defect defect : kDefects) {
      const Scene scene =
          defect == Defect::none
              ? healthy
              : small(defectScene(dials, defect, View::a4c, kKeyframes, Look::smooth));
      const std::vector<RegionFinding> regions =
          perfect.against(scannedLoop(scene, kFitFrames, ++seed));
      const Detected detected = detectedBy(regions);
      EXPECT_EQ(detected.in_septum, defect != Defect::none) << nameOf(defect);
      if (defect == Defect::none) {
        EXPECT_EQ(detected.significant, 0);
      }
      for (const RegionFinding& r : regions)
        if (r.segment == 9) {
          std::printf("%s: %s: %+.1f mm, change %+.1f mm\n", nameOf(defect), r.name.c_str(),
                      r.offset_mm, r.motion_mm);
          // Thick: the edges lie inside the chamber; a hole: outside; still: outside at
          // end-systole.
          EXPECT_EQ(r.offset_mm < -1, defect == Defect::thick);
          EXPECT_EQ(r.motion_mm > 2, defect == Defect::still);
        }
    }
  });
}

// A map of one structure with a segment: 12 pieces with an offset that changes over the beat.
FitMap mapOf(double at_rest_mm, double at_systole_mm, float certainty, int pieces = 12) {
  FitMap map;
  for (int n = 0; n < kFitFrames; ++n) {
    const double phase = static_cast<double>(n) / kFitFrames,
                 mm = phase > 0.2 && phase < 0.6 ? at_systole_mm : at_rest_mm;
    map.boundary.emplace_back(
        static_cast<std::size_t>(pieces),
        BoundaryOffset{0, 0, static_cast<float>(mm), certainty, -1, 0, 9, true});
  }
  return map;
}

std::vector<RegionFinding> findingsOf(const FitMap& loop, const std::vector<FitMap>& twins) {
  FitReport report;
  report.map = loop;
  report.structures = {"cavity"};
  report.systole = 0.4;
  return regionFindings(report, twins, kKnownDials);
}

// Closed forms: the twins' mean is subtracted, their spread widens the standard deviation.
TEST(FitRegions, TheMeanOfTheTwinsIsSubtractedAndTheirSpreadIsNoise) {
  const std::vector<FitMap> equal(3, mapOf(-3, -3, 0.5F)),
      apart{mapOf(-4, -4, 0.5F), mapOf(-3, -3, 0.5F), mapOf(-2, -2, 0.5F)};
  for (const RegionFinding& r : findingsOf(mapOf(-3, -3, 0.5F), equal)) {
    EXPECT_NEAR(r.offset_mm, 0, 1e-6);
    EXPECT_NEAR(r.motion_mm, 0, 1e-6);
    EXPECT_FALSE(r.significant);
  }
  const auto still = findingsOf(mapOf(-3, 2, 0.5F), equal),
             noisy = findingsOf(mapOf(-3, 2, 0.5F), apart);
  ASSERT_EQ(still.size(), 2u);  // the structure, then the segment
  EXPECT_EQ(still[0].name, "cavity");
  EXPECT_EQ(still[1].segment, 9u);
  EXPECT_EQ(still[1].name, "mid inferoseptal");
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_NEAR(still[i].motion_mm, 5, 1e-6);
    EXPECT_NEAR(still[i].offset_mm, 5 * 7 / 20.0, 1e-6);  // frames 5 to 11
    EXPECT_TRUE(still[i].significant);
    // Variance 1 of the twins, 1/3 of their mean.
    EXPECT_NEAR(noisy[i].offset_sd_mm * noisy[i].offset_sd_mm -
                    still[i].offset_sd_mm * still[i].offset_sd_mm,
                4.0 / 3, 1e-6);
    EXPECT_NEAR(noisy[i].motion_sd_mm, still[i].motion_sd_mm, 1e-6);
  }
}

// Twelve pieces of each segment, with one offset over the beat.
FitMap segmentsOf(const std::map<int, double>& offsets_mm) {
  FitMap map;
  for (int n = 0; n < kFitFrames; ++n) {
    map.boundary.emplace_back();
    for (const auto& [segment, mm] : offsets_mm)
      for (int i = 0; i < 12; ++i)
        map.boundary.back().push_back(
            {0, 0, static_cast<float>(mm), 0.5F, -1, 0, static_cast<std::uint8_t>(segment), true});
  }
  return map;
}

// A segment against the mean of its neighbours along the wall or round it, if it has two.
TEST(FitRegions, ASegmentIsComparedWithItsNeighbours) {
  struct Case {
    std::map<int, double> loop;
    std::map<int, double> local;
  };
  for (const Case& c :
       {Case{{{3, 1}, {9, 4}, {14, 2}, {17, 1}, {16, 0}, {12, 1}, {6, 1}},  // four chambers
             {{9, 2.5}, {14, -0.5}, {17, 0}, {16, -1}, {12, 0.5}}},
        Case{{{7, 1}, {8, 5}, {9, 1}, {10, 1}, {11, 1}, {12, 3}},  // short axis
             {{7, -3}, {8, 4}, {9, -2}, {10, 0}, {11, -1}, {12, 2}}},
        Case{{{14, 1}, {17, 4}, {16, 0}}, {{17, 3.5}}},  // the apex is not its own neighbour
        Case{{{13, 1}, {14, 2}, {15, 3}, {16, 6}}, {{13, -3}, {14, 0}, {15, -1}, {16, 4}}}}) {
    std::map<int, double> twin = c.loop;
    for (auto& [segment, mm] : twin) mm = 0;
    const std::vector<FitMap> twins(3, segmentsOf(twin));
    for (const RegionFinding& r : findingsOf(segmentsOf(c.loop), twins)) {
      if (r.segment == 0) {
        EXPECT_FALSE(r.local_mm);
        continue;
      }
      const auto wanted = c.local.find(static_cast<int>(r.segment));
      ASSERT_EQ(r.local_mm.has_value(), wanted != c.local.end()) << r.name;
      if (!r.local_mm) continue;
      EXPECT_NEAR(*r.local_mm, wanted->second, 1e-5) << r.name;
      EXPECT_NEAR(r.local_sd_mm, kKnownDials.local_mm, 1e-6);
    }
  }
}

// Between own look and plain fits; never beyond.
TEST(FitRegions, TheFloorGrowsAsTheAgreementFalls) {
  const auto isAt = [](double agreement, double plain) {
    const RegionFloor floor = floorWithOwnLook(agreement);
    EXPECT_NEAR(floor.segment_mm, 0.5 + plain * 0.4, 1e-12) << agreement;
    EXPECT_NEAR(floor.structure_mm, 0.8 + plain * 0.2, 1e-12) << agreement;
    EXPECT_NEAR(floor.local_mm, 0.3 + plain * 0.2, 1e-12) << agreement;
  };
  isAt(1, 0), isAt(0.95, 0.5), isAt(0.9, 1), isAt(0, 1);
}

TEST(FitRegions, WhatIsHardlyVisibleIsNotSignificant) {
  const std::vector<FitMap> twins(2, mapOf(-3, -3, 0.5F));
  for (const FitMap& loop : {mapOf(0, 30, 0.05F), mapOf(0, 30, 0.5F, 4)})
    for (const RegionFinding& r : findingsOf(loop, twins)) {
      EXPECT_GT(r.deviations(), kRegionSds);
      EXPECT_FALSE(r.visible);
      EXPECT_FALSE(r.significant);
    }
  const nlohmann::ordered_json json = regionsJson(findingsOf(mapOf(0, 9, 0.5F), twins));
  EXPECT_EQ(json[0]["structure"], "cavity");
  EXPECT_EQ(json[1]["segment"], "mid inferoseptal");
  EXPECT_EQ(json[1]["significant"], true);
}

}  // namespace
}  // namespace echocine::fit
