// Searches of a pose stay within their limits and know their rivals.

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/parallel.h"
#include "fit/dial_grid.h"
#include "fit/own_loop.h"
#include "support/drawn_heart.h"

namespace echocine::fit {
namespace {

using namespace support;

const ModelDiscrepancy& drawnOnce() {
  static const ModelDiscrepancy d(draw(Phantom{}, {0.008, -0.004, 0.1}, 20, 3), fromTheStart(),
                                  Phantom{}.model());
  return d;
}

TEST(FitPose, StartsBeyondTheLimitsAreMovedIntoThem) {
  const PoseLimits limits;
  FitPose far_off;
  far_off.shift_x_m = -0.3;
  far_off.turn_rad = 2;
  far_off.scale = 1.3;  // not free, because the loop has a scale
  const PoseFound found = drawnOnce().refine(Phantom{}.model(), {far_off});
  EXPECT_LE(std::abs(found.pose.shift_x_m), limits.shift * kDepth_m + 1e-12);
  EXPECT_LE(std::abs(found.pose.turn_rad), radiansFromDegrees(limits.turn_deg) + 1e-12);
  EXPECT_EQ(found.pose.scale, 1);
}

TEST(FitPose, StartsOfDifferentTimesAreRefused) {
  FitPose later;
  later.lag = 2;
  for (const std::vector<FitPose>& starts :
       {std::vector<FitPose>{}, {FitPose{}, later}, {later, FitPose{}}}) {
    EXPECT_THROW(drawnOnce().refine(Phantom{}.model(), starts), SceneError);
    EXPECT_THROW(drawnOnce().searchAlsoFrom(Phantom{}.model(), starts), SceneError);
  }
  EXPECT_NO_THROW(drawnOnce().refine(Phantom{}.model(), {later, later}));
}

// A start that leads nowhere lower adds a rival at most; one that leads lower has the optima of the
// search as rivals.
TEST(FitPose, AStartKeepsTheRivalsOfTheSearch) {
  FitPose off;
  off.shift_x_m = 0.025;
  off.shift_z_m = 0.02;
  std::size_t rivals = 0;
  // Small chambers fit into several places.
  for (const double grow_m : {-0.014, -0.011, -0.008, 0.0}) {
    const ModelLoop model = Phantom{.grow_m = grow_m}.model();
    const PoseFound alone = drawnOnce().search(model);
    rivals += alone.rivals.size();
    std::vector<FitPose> starts{alone.pose, off};
    for (const auto& rival : alone.rivals) starts.push_back(rival.first);
    for (const FitPose& start : starts) {
      const PoseFound also = drawnOnce().searchAlsoFrom(model, {start});
      EXPECT_LE(also.discrepancy, alone.discrepancy);
      EXPECT_GE(also.rivals.size(), alone.rivals.size());
      for (std::size_t r = 0; r < also.rivals.size(); ++r) {
        const FitPose& rival = also.rivals[r].first;
        EXPECT_TRUE(std::hypot(rival.shift_x_m - also.pose.shift_x_m,
                               rival.shift_z_m - also.pose.shift_z_m) > 0.005 ||
                    std::abs(rival.turn_rad - also.pose.turn_rad) > radiansFromDegrees(5) ||
                    std::abs(rival.scale - also.pose.scale) > 0.03);
        if (r > 0) {
          EXPECT_LE(also.rivals[r - 1].second, also.rivals[r].second);
        }
      }
    }
  }
  EXPECT_GT(rivals, 0u);
}

// Two values have a slope, but no curvature: neither a minimum nor a confounding follows from them.
TEST(FitGrid, AnAxisOfTwoValuesStaysAtTheBestOne) {
  withThreads(2, [] {
    const std::map<std::string, double> fixed{{"hr", 72}};
    const std::vector<ScanAxis> three{{{"ef", 0.4, 0.6}, 0.1}, {{"edv", 100, 140}, 10}},
        two{{{"ef", 0.4, 0.6}, 0.2}, {{"edv", 100, 140}, 10}};
    const HeartFamily family(
        HeartNodes(fixed, HeartDesign::polynomial({three[0].range, three[1].range}), kFitFrames,
                   {}),
        heart::View::a4c, {});
    const echo::EchoLoop loop =
        OwnHeart({{"ef", 0.5}, {"edv", 120}, {"hr", 72}}, heart::View::a4c, {}, kFitFrames)
            .beats()
            .loop(5);
    const ModelDiscrepancy discrepancy(loop, fromTheStart(),
                                       family.at({0.5, 120}, {}, Focus::left_ventricle));
    const DialGrid measured = holdGrid(three, family, discrepancy, {FitPose{}});
    ASSERT_EQ(measured.minimum.size(), 2u);
    EXPECT_NEAR(measured.minimum[0], 0.5, 0.05);
    EXPECT_EQ(measured.confounding.size(), 2u);
    const DialGrid unmeasured = holdGrid(two, family, discrepancy, {FitPose{}});
    EXPECT_EQ(unmeasured.points.size(), 10u);
    ASSERT_EQ(unmeasured.minimum.size(), 2u);
    EXPECT_EQ(unmeasured.minimum[0], unmeasured.points[unmeasured.best].values[0]);
    EXPECT_TRUE(unmeasured.curvature.empty());
    EXPECT_TRUE(unmeasured.confounding.empty());
  });
}

}  // namespace
}  // namespace echocine::fit
