// Which views are asked for, and what ranks them: closed forms.

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/error.h"
#include "core/parallel.h"
#include "fit/coverage.h"
#include "fit/view_ranking.h"
#include "support/drawn_heart.h"

namespace echocine::fit {

using namespace echo;
namespace {

using namespace support;

TEST(CompareViewsAsked, ViewsAreReadOrRefusedByName) {
  // All but the transoesophageal one, which can be named.
  EXPECT_EQ(parseViews("all").size(), heart::viewNames().size() - 1);
  EXPECT_EQ(parseViews("a4c,tee-4c").back(), heart::View::tee_4c);
  const std::vector<heart::View> two = parseViews("plax,psax-mid");
  ASSERT_EQ(two.size(), 2u);
  EXPECT_EQ(two[0], heart::View::plax);
  EXPECT_EQ(two[1], heart::View::psax_mid);
  for (const char* bad : {"", "a4c", "a4c,", "a4c,a4c", "a4c,a5c", "a4c;a2c", "all,a4c", "ALL"}) {
    try {
      parseViews(bad);
      ADD_FAILURE() << bad;
    } catch (const SceneError& error) {
      EXPECT_NE(std::string(error.what()).find("--views"), std::string::npos) << error.what();
    }
  }
}

TEST(CompareViewsAsked, DialsThatAreGivenLeaveThePopulation) {
  const std::vector<ScanAxis> all = populationWithout({});
  ASSERT_EQ(all.size(), 2u);
  const std::vector<ScanAxis> one = populationWithout({{"ef", 0.5}, {"hr", 72}});
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].range.key, "edv");
  EXPECT_EQ(one[0].values().front(), 80);
  EXPECT_EQ(one[0].values().back(), 220);
  EXPECT_TRUE(populationWithout({{"ef", 0.5}, {"edv", 120}}).empty());
}

// What claims nothing says nothing, what claims all is D, and two halves multiply.
TEST(CompareViewsAsked, WhatIsLeftOfAPictureIsAMeanOverIt) {
  for (const double d : {0.1, 0.5, 0.9}) {
    EXPECT_EQ(pictureDiscrepancy(d, 0), 1);
    EXPECT_NEAR(pictureDiscrepancy(d, 1), d, 1e-15);
    EXPECT_NEAR(pictureDiscrepancy(d, 0.3) * pictureDiscrepancy(d, 0.7), d, 1e-15);
    EXPECT_LT(pictureDiscrepancy(d, 0.6), pictureDiscrepancy(d, 0.5));
  }
  EXPECT_EQ(pictureDiscrepancy(1, 0.4), 1);
  // A model that claims twice as much may be worse where it does: 0.81 is 0.9 squared.
  EXPECT_NEAR(pictureDiscrepancy(0.9, 0.4), pictureDiscrepancy(0.81, 0.2), 1e-15);
}

// Cells that all count in full cover the sector but for its rim; half of them cover half of it, and
// none of them where the pose moves them out.
TEST(CompareViewsAsked, TheClaimIsTheShareOfTheSectorsArea) {
  ModelLoop model = Phantom{}.model();
  for (ModelFrame& frame : model.frames)
    for (TissueCell& cell : frame.cells)
      cell.area = static_cast<float>(std::hypot(cell.x_m, cell.z_m) / kDepth_m);
  withThreads(2, [&] {
    const ModelDiscrepancy d(draw(Phantom{}, {}, 10, 3), fromTheStart(), model);
    const double all = coverageOf(model, d.stack(), {});
    EXPECT_NEAR(all, 1, 0.03);
    ModelLoop half = model;
    for (ModelFrame& frame : half.frames)
      for (TissueCell& cell : frame.cells)
        if (cell.x_m < 0) cell.area = 0;
    EXPECT_NEAR(coverageOf(half, d.stack(), {}), all / 2, 1e-3);
    ModelLoop faint = model;
    for (ModelFrame& frame : faint.frames)
      for (TissueCell& cell : frame.cells) cell.area *= 0.25f;
    EXPECT_NEAR(coverageOf(faint, d.stack(), {}), all / 4, 1e-6);
    FitPose away;
    away.shift_z_m = 1.2 * kDepth_m;
    EXPECT_EQ(coverageOf(model, d.stack(), away), 0);
    // Twice as large, within the sector: four times the claim.
    ModelLoop small = model;
    for (ModelFrame& frame : small.frames)
      for (TissueCell& cell : frame.cells)
        if (std::hypot(cell.x_m, cell.z_m - kMiddle_m) > 0.02) cell.area = 0;
    FitPose twice;
    twice.scale = 2;
    EXPECT_NEAR(coverageOf(small, d.stack(), twice), 4 * coverageOf(small, d.stack(), {}),
                0.01 * all);
  });
}

}  // namespace
}  // namespace echocine::fit
