// What has no solution is never the best, and input that no loop has is refused by name.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "fit/caveats.h"
#include "fit/tissue_greys.h"
#include "fit/view_ranking.h"
#include "support/drawn_heart.h"

namespace echocine::fit {

using namespace echo;
namespace {

// Blood of less weight than its strips take away: no least squares, so the worst ratio and not 0.
TEST(FitFailures, SumsWithoutLeastSquaresAreTheWorst) {
  TissueGreys greys({true, false});
  for (int i = 0; i < 40; ++i) {
    const double depth = i / 39.0;
    greys.add(1, 1, 1, depth, 120 + 20 * std::sin(i), 1);
    greys.add(0, 0, 1, depth, 30 + 5 * std::cos(i), 0.2);
    greys.add(0, 0, 1, depth, 60, -0.3);
  }
  const TissueGreys::Fit fit = greys.fit();
  EXPECT_FALSE(fit.solved);
  EXPECT_EQ(fit.ratio(), 1);
}

// The residual is that of the greys that were found, cell by cell.
TEST(FitFailures, TheResidualIsWhatTheGreysLeave) {
  TissueGreys greys({true, false});
  std::vector<double> cells;
  for (int i = 0; i < 60; ++i) {
    cells.push_back((i % 2 == 0 ? 40 : 130) + 9 * std::sin(1.7 * i));
    greys.add(i % 2, i % 2, 1, i / 59.0, cells.back(), 1);
  }
  const TissueGreys::Fit fit = greys.fit();
  ASSERT_TRUE(fit.solved);
  double residual = 0;
  for (int i = 0; i < 60; ++i) {
    const double place = i / 59.0 * (kGainKnots - 1);
    const int knot = std::min(static_cast<int>(place), kGainKnots - 2);
    const double gain = fit.gain[knot] + (place - knot) * (fit.gain[knot + 1] - fit.gain[knot]);
    residual += std::pow(
        cells[static_cast<std::size_t>(i)] - fit.grey[static_cast<std::size_t>(i % 2)] - gain, 2);
  }
  EXPECT_NEAR(fit.residual, residual, 1e-6 * residual);
  EXPECT_GT(fit.ratio(), 0);
  EXPECT_LT(fit.ratio(), 1);
}

TEST(FitFailures, OneViewAloneIsRefused) {
  const EchoLoop real = support::draw(support::Phantom{}, {}, 5, 3);
  for (const std::vector<heart::View>& views :
       {std::vector<heart::View>{}, std::vector<heart::View>{heart::View::a4c}}) {
    ViewsOptions options;
    options.views = views;
    EXPECT_THROW(rankViews(real, options), SceneError);
  }
}

TEST(FitFailures, NumbersThatNoLoopHasAreRefusedByName) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const auto refusal = [](const SideOptions& side) -> std::string {
    try {
      checkSide(side);
    } catch (const SceneError& error) {
      return error.what();
    }
    return "";
  };
  for (const double bad : {kNan, 0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    SideOptions side;
    side.mm_per_pixel = bad;
    EXPECT_TRUE(refusal(side).starts_with("mm_per_pixel: is")) << bad;
    side = {};
    side.fps = bad;
    EXPECT_TRUE(refusal(side).starts_with("fps: is")) << bad;
    side = {};
    side.heart_rate_bpm = bad;
    EXPECT_TRUE(refusal(side).starts_with("heart_rate_bpm: is")) << bad;
  }
  for (const std::vector<double>& waves : {std::vector{0.9, 0.4}, {0.4, 0.4}}) {
    SideOptions side;
    side.r_waves_s = waves;
    EXPECT_TRUE(refusal(side).starts_with("r_waves_s: are not in order"));
  }
  EchoLoop real = support::draw(support::Phantom{}, {}, 5, 3);
  real.metres_per_pixel = kNan;
  EXPECT_THROW(ModelDiscrepancy(real, {}, support::Phantom{}.model()), SceneError);
}

TEST(FitFailures, WhatAReaderMustKnowStandsWithTheResult) {
  EchoLoop real;
  real.metres_per_pixel = 4e-4;
  EXPECT_TRUE(caveatsOf(real, {}, 0.5).empty());
  ASSERT_EQ(caveatsOf(real, {}, 0.08).size(), 1u);
  EXPECT_EQ(caveatsOf(real, {}, 0.08)[0], "only a hint: its confidence of 0.08 is below 0.1");
  real.metres_per_pixel.reset();
  BeatFound beat;
  beat.length_source = kLoopIsBeat;
  const std::vector<std::string> all = caveatsOf(real, beat, 0.5);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_TRUE(all[0].starts_with("scale unknown"));
  EXPECT_EQ(all[1], "the loop is assumed to be one beat");
}

}  // namespace
}  // namespace echocine::fit
